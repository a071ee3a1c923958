// The documents that are written from the tables of parameters, channels and effects.
#include "model_files/model_tables.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

const std::filesystem::path kDocuments = STRUT_SOURCE_DIR "/docs";

struct WrittenDocument {
  const char* name;
  std::string (*write)();
};
constexpr WrittenDocument kWritten[] = {{"parameters.md", write_parameters_document},
                                        {"channels.md", write_channels_document},
                                        {"effects.md", write_effects_document}};

TEST_CASE("Documents written from tables are what the tables say", "[io]") {
  // Mend them by: strut_tests_model_files "Write the documents of the tables"
  for (const WrittenDocument& document : kWritten) {
    INFO(document.name);
    CHECK(test::read_text(kDocuments / document.name) == document.write());
  }
}

TEST_CASE("Write the documents of the tables", "[.]") {
  for (const WrittenDocument& document : kWritten) {
    std::ofstream(kDocuments / document.name, std::ios::binary) << document.write();
  }
}

}  // namespace
}  // namespace strut
