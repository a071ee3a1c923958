// The documents that are written from the tables of parameters and channels.
#include "model_files/model_tables.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

const std::filesystem::path kDocuments = STRUT_SOURCE_DIR "/docs";

TEST_CASE("docs/parameters.md and docs/channels.md are what the tables say", "[io]") {
  // Mend them by: strut_tests_model_files "Write docs/parameters.md and docs/channels.md"
  CHECK(test::read_text(kDocuments / "parameters.md") == write_parameters_document());
  CHECK(test::read_text(kDocuments / "channels.md") == write_channels_document());
}

TEST_CASE("Write docs/parameters.md and docs/channels.md", "[.]") {
  std::ofstream(kDocuments / "parameters.md", std::ios::binary) << write_parameters_document();
  std::ofstream(kDocuments / "channels.md", std::ios::binary) << write_channels_document();
}

}  // namespace
}  // namespace strut
