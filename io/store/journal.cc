#include "io/store/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <optional>
#include <string_view>

#include "base/text/format_number.h"
#include "base/text/parse_number.h"
#include "io/file/sha256.h"

namespace strut {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirstKey = "file=";
constexpr std::string_view kCheckKey = " check=";
constexpr std::size_t kCheckDigits = 16;

using Fields = std::map<std::string, std::string, std::less<>>;

// Percent-encodes all characters that could be mistaken for delimiters of the line.
std::string encode(std::string_view text) {
  constexpr std::string_view kPlain = "._/+-";
  std::string code;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (letter || kPlain.find(c) != std::string_view::npos) {
      code += c;
    } else {
      code += fmt::format("%{:02X}", byte);
    }
  }
  return code;
}

std::string decode(std::string_view code) {
  std::string text;
  for (std::size_t i = 0; i < code.size(); ++i) {
    unsigned value = static_cast<unsigned char>(code[i]);
    if (code[i] == '%' && i + 2 < code.size()) {
      std::from_chars(code.data() + i + 1, code.data() + i + 3, value, 16);
      i += 2;
    }
    text += static_cast<char>(value);
  }
  return text;
}

template <typename Number>
bool read_number(std::string_view text, Number& value) {
  const auto parsed = parse_number<Number>(text);
  value = parsed.value_or(Number{});
  return parsed.has_value();
}

std::string calc_check(std::string_view text) {
  return to_hex(calc_sha256(std::string(text))).substr(0, kCheckDigits);
}

std::string write_failures(const std::map<std::string, std::int64_t>& failures) {
  std::string text;
  for (const auto& [reason, cases] : failures) {
    text += fmt::format("{}{}:{}", text.empty() ? "" : ",", encode(reason), cases);
  }
  return text;
}

std::string write_line(const JournalEntry& entry) {
  const std::string line = fmt::format(
      "{}{} cases={} failures={} bytes={} sha256={} digest={} seconds={} time={} runner={} "
      "duplicate={:d}",
      kFirstKey, encode(entry.file), entry.cases, write_failures(entry.failures), entry.bytes,
      encode(entry.sha256), encode(entry.digest), format_number(entry.seconds), entry.time,
      encode(entry.runner), entry.duplicate);
  return fmt::format("{}{}{}\n", line, kCheckKey, calc_check(line));
}

// Removes the part of `text` before the first `mark`, and the mark, and returns the part.
std::string_view cut(std::string_view& text, char mark) {
  const auto at = text.find(mark);
  const std::string_view head = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return head;
}

bool read_failures(std::string_view text, std::map<std::string, std::int64_t>& failures) {
  while (!text.empty()) {
    std::string_view count = cut(text, ',');
    const std::string reason = decode(cut(count, ':'));
    if (!read_number(count, failures[reason])) return false;
  }
  return true;
}

Fields read_fields(std::string_view text) {
  Fields fields;
  while (!text.empty()) {
    std::string_view value = cut(text, ' ');
    const std::string key(cut(value, '='));
    fields[key] = value;
  }
  return fields;
}

// Parses the part of a line before its checksum, which was correct. Unknown keys, which a newer
// version may write, are ignored.
std::optional<JournalEntry> read_entry(std::string_view text) {
  Fields fields = read_fields(text);
  JournalEntry entry;
  entry.file = decode(fields["file"]);
  entry.sha256 = decode(fields["sha256"]);
  entry.digest = decode(fields["digest"]);
  entry.runner = decode(fields["runner"]);
  entry.duplicate = fields["duplicate"] == "1";
  const bool whole =
      read_number(fields["cases"], entry.cases) && read_number(fields["bytes"], entry.bytes) &&
      read_number(fields["seconds"], entry.seconds) && read_number(fields["time"], entry.time) &&
      read_failures(fields["failures"], entry.failures);
  return whole ? std::optional(entry) : std::nullopt;
}

// Adds the entries of one line, or of several that a damaged line end joined: each entry begins
// with the first key, which encoded values cannot contain, and ends with its checksum. Returns
// whether the line is exactly one whole entry.
bool add_line(std::string_view line, std::vector<JournalEntry>& entries) {
  bool clean = line.starts_with(kFirstKey);
  std::size_t found = 0;
  for (auto at = line.find(kFirstKey); at != std::string_view::npos;) {
    const auto next = line.find(kFirstKey, at + 1);
    const std::string_view piece = line.substr(at, next - at);
    at = next;
    const auto check = piece.find(kCheckKey);
    if (check == std::string_view::npos) continue;
    const std::string_view text = piece.substr(0, check);
    const std::string_view rest = piece.substr(check + kCheckKey.size());
    if (rest.substr(0, kCheckDigits) != calc_check(text)) continue;
    clean = clean && rest.size() == kCheckDigits;
    const auto entry = read_entry(text);
    if (!entry) continue;
    entries.push_back(*entry);
    ++found;
  }
  return clean && found == 1;
}

// Two runners may see the same torn end, or one may see a line that another is writing: the result
// is an empty line, which is ignored.
bool ends_torn(int descriptor, off_t size) {
  char last = '\n';
  return size > 0 && ::pread(descriptor, &last, 1, size - 1) == 1 && last != '\n';
}

}  // namespace

void append_journal(const Folder& folder, const std::string& name, const JournalEntry& entry) {
  const fs::path journal = folder.path_of(name);
  const FileDescriptor file = folder.open_file(name, O_RDWR | O_CREAT | O_APPEND);
  if (!file.is_open()) throw file_failure(journal, kNotWritten, errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) throw file_failure(journal, kNotWritten, errno);
  const std::string line = (ends_torn(file.get(), status.st_size) ? "\n" : "") + write_line(entry);
  const std::ptrdiff_t written = write_once(file.get(), std::as_bytes(std::span(line)));
  if (written < 0) throw file_failure(journal, kNotWritten, errno);
  // A write is partial only if space runs out. Another runner might write before the rest, so the
  // line stays torn.
  if (static_cast<std::size_t>(written) != line.size()) {
    throw file_failure(journal, kNotWritten, ENOSPC);
  }
  flush_file(file.get(), journal);
  if (status.st_size == 0) folder.flush(journal);
}

Journal read_journal(const fs::path& journal) {
  Journal result;
  const std::string text = read_if_present(journal).value_or("");
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = cut(rest, '\n');
    if (!line.empty() && !add_line(line, result.entries)) ++result.bad_lines;
  }
  return result;
}

}  // namespace strut
