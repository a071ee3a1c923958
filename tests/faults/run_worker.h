// Runs the worker or another program, under the preloaded faults where asked.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>

#include "tests/jobs/run_program.h"

namespace strut::test {

/// Shell variables that preload the library for `folder`; `more`: STRUT_FAULT=..., quoted.
inline std::string preload_faults(const std::filesystem::path& folder, const std::string& more) {
  return "ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0 LD_PRELOAD=" STRUT_FILE_FAULTS
         " STRUT_FAULT_FOLDER=" +
         folder.string() + " " + more;
}

/// `variables`: what stands before the command in a shell.
inline Outcome run_worker(const std::string& variables, const std::string& arguments) {
  return run_shell(variables + " exec " STRUT_WORKER " " + arguments);
}

/// `worker hold FOLDER UNIT` in the background.
class Holder {
 public:
  Holder(const std::filesystem::path& folder, const std::string& unit) {
    const std::string command = "exec " STRUT_WORKER " hold " + folder.string() + " " + unit;
    pipe_ = ::popen(command.c_str(), "r");
    REQUIRE(pipe_ != nullptr);
    std::array<char, 512> line{};
    REQUIRE(std::fgets(line.data(), line.size(), pipe_) != nullptr);
    const std::string answer(line.data());
    is_mine_ = answer.starts_with("mine ");
    runner_ = answer.substr(answer.find(' ') + 1);
    runner_.pop_back();
    const auto dot = runner_.rfind('.', runner_.rfind('.') - 1);
    process_ = std::stoi(runner_.substr(dot + 1));
  }
  ~Holder() { end(SIGKILL); }
  Holder(const Holder&) = delete;
  Holder& operator=(const Holder&) = delete;

  bool is_mine() const { return is_mine_; }
  const std::string& runner() const { return runner_; }
  void send(int signal) const { ::kill(process_, signal); }
  /// Sends the signal and waits for the end, which nobody asked for yet: a zombie.
  void end_unasked(int signal) const {
    send(signal);
    siginfo_t info{};
    ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOWAIT);
  }
  void end(int signal) {
    if (pipe_ == nullptr) return;
    send(signal);
    ::pclose(pipe_);
    pipe_ = nullptr;
  }

 private:
  FILE* pipe_ = nullptr;
  bool is_mine_ = false;
  std::string runner_;
  pid_t process_ = 0;
};

}  // namespace strut::test
