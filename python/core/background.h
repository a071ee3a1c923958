// Long work beside Python: without the interpreter's lock, ended by Ctrl-C and by the program's
// end.
#pragma once

#include <atomic>
#include <functional>

namespace strut {

/// Calls `work(stop)` in a thread of its own. Meanwhile this thread gives other Python threads the
/// lock, looks for signals ten times a second, and calls `watch` as often. An exception of a signal
/// handler or of `watch` sets `stop` and is thrown when `work` has returned; so is one of `work`.
/// At the program's end `stop` is set, too.
void run_in_background(const std::function<void(std::atomic<bool>& stop)>& work,
                       const std::function<void()>& watch = {});

/// Lets the interpreter wait at its end for the work of other threads, which would otherwise go on
/// while what it uses is destroyed. Called once, by the module.
void end_work_with_interpreter();

}  // namespace strut
