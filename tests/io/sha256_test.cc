#include "io/file/sha256.h"

#include <catch2/catch.hpp>

#include "base/error/input_error.h"
#include "io/store/data_digest.h"

namespace strut {
namespace {

// FIPS 180-4 and NIST's example messages for SHA-256.
TEST_CASE("SHA-256 gives the published hashes", "[unit][reference]") {
  CHECK(to_hex(calc_sha256("")) ==
        "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(to_hex(calc_sha256("abc")) ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(to_hex(calc_sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")) ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(to_hex(calc_sha256(std::string(1000000, 'a'))) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 of pieces equals that of the whole, and finish() starts a new hash",
          "[unit][property]") {
  const std::string text(1000, 'q');
  Sha256 hash;
  for (const std::size_t first : {0U, 1U, 63U, 64U, 65U, 1000U}) {
    hash.update(text.substr(0, first));
    hash.update(text.substr(first));
    CHECK(hash.finish() == calc_sha256(text));
  }
  CHECK(hash.finish() == calc_sha256(""));
}

Hash row(int i) { return calc_sha256("row " + std::to_string(i)); }

DataDigest digest_of(const std::vector<int>& rows) {
  DataDigest digest;
  for (const int i : rows) digest.add(row(i));
  return digest;
}

TEST_CASE("A digest depends on the rows, not on their order or grouping", "[unit][property]") {
  const DataDigest digest = digest_of({1, 2, 3, 4});
  CHECK(digest == digest_of({4, 2, 1, 3}));
  CHECK(digest.count() == 4);
  DataDigest grouped = digest_of({3, 1});
  grouped.add(digest_of({4, 2}));
  CHECK(grouped == digest);
  CHECK(grouped.text() == digest.text());
  CHECK(digest.text().size() == 64);
  for (const auto& others : {std::vector{1, 2, 3}, {1, 2, 3, 5}, {1, 2, 3, 3}, {1, 2, 3, 4, 4}}) {
    CHECK(digest.text() != digest_of(others).text());
  }
}

// Independent reference: the same sum in Python integers,
//   h = hashlib.sha256; w = lambda b: [int.from_bytes(b[i:i+8], "little") for i in (0, 8, 16, 24)]
TEST_CASE("The state of a digest is count and sum", "[unit][reference]") {
  CHECK(DataDigest().state() == "0:0:0:0:0");
  CHECK(digest_of({1, 2}).state() ==
        "2:276f7822d72cdbcf:db1e51a6d0f313e6:bebcf162583df3ca:19b563fb32c7f641");
  CHECK(digest_of({1, 2}).text() ==
        "c30796ff381d52c2a0706f656966dab770d2e6a5ab4b0e6aed90d62eaeae74b0");
}

TEST_CASE("Only the state of a digest reads back", "[unit]") {
  const DataDigest digest = digest_of({1, 2, 3});
  CHECK(DataDigest::parse(digest.state()) == digest);
  const std::string state = digest.state();
  for (const std::string& bad :
       {std::string(), state + ":", state + "0", " " + state, "0" + state, "-" + state,
        state.substr(0, state.rfind(':')), std::string("0:0:0:0:10000000000000000"),
        std::string("0:0:0:0:A"), std::string("0;0;0;0;0")}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(DataDigest::parse(bad), InputError);
  }
}

}  // namespace
}  // namespace strut
