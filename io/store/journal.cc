#include "io/store/journal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string_view>

#include "base/text/parse_number.h"
#include "io/file/sha256.h"

namespace strut {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirstKey = "file=";
constexpr std::string_view kCheckKey = " check=";
constexpr std::size_t kCheckDigits = 16;
constexpr const char* kNotWritten = "cannot be written";

using Fields = std::map<std::string, std::string, std::less<>>;

// Percent-encoding of all that could be mistaken for the line's own marks.
std::string encode(std::string_view text) {
  constexpr std::string_view kPlain = "._/+-";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string code;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (letter || kPlain.find(c) != std::string_view::npos) {
      code += c;
    } else {
      code += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
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
std::string write_number(Number value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
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
    if (!text.empty()) text += ',';
    text += encode(reason) + ':' + write_number(cases);
  }
  return text;
}

std::string write_line(const JournalEntry& entry) {
  std::string line(kFirstKey);
  line += encode(entry.file);
  line += " cases=" + write_number(entry.cases);
  line += " failures=" + write_failures(entry.failures);
  line += " bytes=" + write_number(entry.bytes);
  line += " sha256=" + encode(entry.sha256);
  line += " digest=" + encode(entry.digest);
  line += " seconds=" + write_number(entry.seconds);
  line += " time=" + write_number(entry.time);
  line += " runner=" + encode(entry.runner);
  line += " duplicate=" + write_number(static_cast<int>(entry.duplicate));
  line += std::string(kCheckKey) + calc_check(line);
  return line + '\n';
}

// Cuts what stands before the first `mark` off `text`, and the mark.
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

// `text` is a line up to its checksum, which was right. A key that is not known is left for a
// newer version.
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

// One line, or several whose ends between them were damaged: each entry begins with the first key,
// which encoded values cannot contain, and ends with its checksum. False: there was more, or less,
// than one whole entry.
bool add_line(std::string_view line, std::vector<JournalEntry>& entries) {
  bool clean = line.substr(0, kFirstKey.size()) == kFirstKey;
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

// Two runners may see the same torn end, or one the line that another is just writing: then there
// is an empty line, which means nothing.
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
  // A file takes less than it is given only where space ends. The rest would not follow directly if
  // another runner wrote meanwhile, so the line stays torn.
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
