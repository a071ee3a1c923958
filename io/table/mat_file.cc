#include "io/table/mat_file.h"

#include <fmt/format.h>
#include <matio.h>

#include <algorithm>
#include <utility>

#include "io/table/mat_structure.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Structs in structs that are searched.
constexpr int kMaxDepth = 4;
/// Columns of a matrix that is taken for a table.
constexpr std::size_t kMaxTableColumns = 1024;

struct CloseMat {
  void operator()(mat_t* file) const { Mat_Close(file); }
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};

/// Values of a numeric array as doubles; empty for other classes.
std::vector<double> copy_values(const matvar_t& v, std::size_t count) {
  const auto copy = [&](const auto* data) { return std::vector<double>(data, data + count); };
  switch (v.data_type) {
    case MAT_T_DOUBLE:
      return copy(static_cast<const double*>(v.data));
    case MAT_T_SINGLE:
      return copy(static_cast<const float*>(v.data));
    case MAT_T_INT8:
      return copy(static_cast<const mat_int8_t*>(v.data));
    case MAT_T_UINT8:
      return copy(static_cast<const mat_uint8_t*>(v.data));
    case MAT_T_INT16:
      return copy(static_cast<const mat_int16_t*>(v.data));
    case MAT_T_UINT16:
      return copy(static_cast<const mat_uint16_t*>(v.data));
    case MAT_T_INT32:
      return copy(static_cast<const mat_int32_t*>(v.data));
    case MAT_T_UINT32:
      return copy(static_cast<const mat_uint32_t*>(v.data));
    default:
      return {};
  }
}

bool is_numeric(const matvar_t& v) {
  return v.class_type >= MAT_C_DOUBLE && v.class_type <= MAT_C_UINT32 && v.isComplex == 0;
}

class MatFile : public TableFile {
 public:
  explicit MatFile(const fs::path& path) : path_(path) {
    const MatStructure structure = check_mat_structure(path);
    const std::unique_ptr<mat_t, CloseMat> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
    if (file == nullptr) throw InputError(path.string() + ": damaged, or not a MATLAB file");
    for (std::size_t i = 0; i < structure.whole_count; ++i) {
      const std::unique_ptr<matvar_t, CloseMat> variable(Mat_VarReadNext(file.get()));
      if (variable == nullptr) {
        notes_.push_back(fmt::format("{}: {} of {} variables cannot be read", path.string(),
                                     structure.whole_count - i, structure.whole_count));
        break;
      }
      if (variable->name != nullptr) add(*variable, variable->name, 0);
    }
    if (columns_.empty()) {
      throw InputError(path.string() + ": no numeric variable, or damaged from its first one on");
    }
    if (structure.is_cut_off) {
      notes_.push_back(fmt::format("{}: the file is cut off; what follows {} is missing",
                                   path.string(), columns_.back().name));
    }
  }

  std::string format() const override { return "MATLAB 5"; }

  std::vector<std::string> names() const override {
    std::vector<std::string> names;
    names.reserve(columns_.size());
    for (const CsvColumn& column : columns_) names.push_back(column.name);
    return names;
  }

  CsvColumn read(const std::string& name) const override {
    for (const CsvColumn& column : columns_) {
      if (column.name == name) return column;
    }
    throw missing_column_error(path_, name, names());
  }

  std::vector<std::string> notes() const override { return notes_; }

 private:
  void add(const matvar_t& v, const std::string& name, int depth) {
    if (v.rank != 2 || v.dims == nullptr || v.data == nullptr) return;
    if (v.class_type == MAT_C_STRUCT && depth < kMaxDepth && v.dims[0] * v.dims[1] == 1) {
      add_fields(v, name, depth);
    } else if (is_numeric(v)) {
      add_numbers(v, name);
    }
  }

  void add_fields(const matvar_t& v, const std::string& name, int depth) {
    const unsigned count = Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&v));
    char* const* fields = Mat_VarGetStructFieldnames(&v);
    for (unsigned i = 0; fields != nullptr && i < count; ++i) {
      const matvar_t* field = Mat_VarGetStructFieldByIndex(const_cast<matvar_t*>(&v), i, 0);
      if (field != nullptr && fields[i] != nullptr) {
        add(*field, fmt::format("{}.{}", name, fields[i]), depth + 1);
      }
    }
  }

  void add_numbers(const matvar_t& v, const std::string& name) {
    const std::size_t rows = v.dims[0], columns = v.dims[1], count = rows * columns;
    const auto size = static_cast<std::size_t>(std::max(v.data_size, 0));
    if (count == 0 || size == 0 || v.nbytes / size < count) return;
    const std::vector<double> values = copy_values(v, count);
    if (values.empty()) return;
    if (rows == 1 || columns == 1) {
      columns_.push_back({name, "", values});
      return;
    }
    for (std::size_t c = 0; c < columns && columns <= kMaxTableColumns; ++c) {
      const auto begin =
          values.begin() + static_cast<std::ptrdiff_t>(c * rows);  // column by column
      columns_.push_back({fmt::format("{}:{}", name, c + 1),
                          "",
                          {begin, begin + static_cast<std::ptrdiff_t>(rows)}});
    }
  }

  fs::path path_;
  std::vector<CsvColumn> columns_;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<TableFile> open_mat_file(const fs::path& path) {
  return std::make_unique<MatFile>(path);
}

}  // namespace strut
