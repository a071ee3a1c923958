#include "jobs/cli/standard_output.h"

#include <unistd.h>

#include <iostream>
#include <string_view>

#include "base/text/utf8.h"

namespace strut {
namespace {

/// Buffers whole lines, so that no multi-byte character is split and then escaped byte by byte.
class EscapingBuffer : public std::streambuf {
 public:
  std::streambuf* target = nullptr;

  void write_control(std::string_view sequence) {
    is_good_ = write_pending(pending_.size()) && put(sequence) && is_good_;
  }

 protected:
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    const char one = traits_type::to_char_type(c);
    return xsputn(&one, 1) == 1 ? c : traits_type::eof();
  }

  std::streamsize xsputn(const char* text, std::streamsize count) override {
    constexpr std::size_t kBytes = 8192;
    pending_.append(text, static_cast<std::size_t>(count));
    if (pending_.size() >= kBytes) {
      const std::size_t line_end = pending_.rfind('\n');
      const bool has_end = line_end != std::string::npos;
      is_good_ = write_pending(has_end ? line_end + 1 : pending_.size()) && is_good_;
    }
    return is_good_ ? count : 0;
  }

  int sync() override {
    is_good_ = write_pending(pending_.size()) && is_good_;
    return target->pubsync() == 0 && is_good_ ? 0 : -1;
  }

 private:
  bool write_pending(std::size_t bytes) {
    const bool good = put(escape_controls(std::string_view(pending_).substr(0, bytes)));
    pending_.erase(0, bytes);
    return good;
  }

  bool put(std::string_view text) {
    return target->sputn(text.data(), std::ssize(text)) == std::ssize(text);
  }

  std::string pending_;
  bool is_good_ = true;  // all output so far was written
};

EscapingBuffer& get_buffer() {
  static EscapingBuffer buffer;
  return buffer;
}

}  // namespace

StandardOutput::StandardOutput() : before_(std::cout.rdbuf(&get_buffer())) {
  get_buffer().target = before_;
}

StandardOutput::~StandardOutput() {
  std::cout.flush();
  std::cout.rdbuf(before_);
}

void print_control(const std::string& sequence) {
  if (std::cout.rdbuf() == &get_buffer()) {
    get_buffer().write_control(sequence);
  } else {
    std::cout << sequence;
  }
}

void print_styled(const std::string& text, Style style) {
  const bool is_styled = shows_colors(STDOUT_FILENO);
  if (is_styled) print_control(get_sequence(style));
  std::cout << text;
  if (is_styled) print_control(kPlainSequence);
}

}  // namespace strut
