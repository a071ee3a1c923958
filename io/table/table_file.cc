#include "io/table/table_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "io/file/file_sync.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

/// Begin of a file and what to do about it.
struct OtherFormat {
  std::string_view begin;
  const char* name;
  const char* advice;
};

constexpr char kAsammdf[] =
    "convert it: python3 -c 'import sys, asammdf; "
    "asammdf.MDF(sys.argv[1]).export(\"csv\", \"recording\", time_from_zero=True)' FILE";
constexpr char kSaveAsText[] = "save it as CSV text";

constexpr std::array<OtherFormat, 9> kOthers = {{
    {"MDF     ", "an MDF measurement (ASAM MDF 3 or 4)", kAsammdf},
    {"UnFinMF ", "an MDF measurement that was not closed", kAsammdf},
    {"PK\x03\x04", "a spreadsheet or a zip archive", kSaveAsText},
    {"\xd0\xcf\x11\xe0", "an Excel spreadsheet of the old kind", kSaveAsText},
    {"TDSm", "a TDMS measurement (National Instruments)",
     "convert it: python3 -m nptdms.tdmsinfo lists it, nptdms.TdmsFile.as_dataframe().to_csv() "
     "writes CSV"},
    {"\x1f\x8b", "compressed by gzip", "decompress it with gunzip"},
    {"\xfd"
     "7zXZ",
     "compressed by xz", "decompress it with unxz"},
    {"LOGG", "a bus log of Vector (BLF)", "decode its signals to CSV first"},
    {"%PDF", "a PDF document", kSaveAsText},
}};

std::string read_begin(const fs::path& path, std::size_t count) {
  std::ifstream stream(path, std::ios::binary);
  std::string bytes(count, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace

bool TableFile::has(const std::string& name) const {
  const std::vector<std::string> all = names();
  return std::find(all.begin(), all.end(), name) != all.end();
}

std::vector<std::string> TextTableFile::names() const {
  std::vector<std::string> names;
  names.reserve(table_.columns.size());
  for (const CsvColumn& column : table_.columns) names.push_back(column.name);
  return names;
}

TableFormat find_table_format(const fs::path& path) {
  constexpr std::string_view kHdf5 = "\x89HDF\r\n\x1a\n"sv, kMatlab = "MATLAB "sv;
  constexpr std::size_t kUserBlock = 512;  // of a MATLAB 7.3 file, before the HDF5 signature
  open_regular_file(path);
  const std::string begin = read_begin(path, kUserBlock + kHdf5.size());
  const std::string extension = path.extension().string();
  const auto behind = [&](std::size_t at) {
    return std::string_view(begin).substr(std::min(at, begin.size()));
  };
  if (extension == ".h5" || extension == ".hdf5" || behind(0).starts_with(kHdf5) ||
      behind(kUserBlock).starts_with(kHdf5)) {
    return TableFormat::kHdf5;
  }
  if (begin.starts_with(kMatlab)) return TableFormat::kMatlab5;
  for (const OtherFormat& other : kOthers) {
    if (!begin.starts_with(other.begin)) continue;
    throw InputError(fmt::format("{}: is {}; {}", path.string(), other.name, other.advice));
  }
  return TableFormat::kText;
}

}  // namespace strut
