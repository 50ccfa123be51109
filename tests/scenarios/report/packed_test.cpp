#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/report/assets.hpp"
#include <lrbscope/ids.hpp>

using namespace lrb;

namespace {

std::string packed_numbers(const std::vector<std::uint32_t>& numbers) {
  return report::packed(numbers);
}

}  // namespace

TEST_CASE("numbers are packed as narrow as the largest allows, low byte first") {
  CHECK(packed_numbers({}) == "u1:");
  CHECK(packed_numbers({1, 2, 254}) == "u1:AQL+");
  CHECK(packed_numbers({255}) == "u2:/wA=");  // all ones in one byte would be none
  CHECK(packed_numbers({0x0102}) == "u2:AgE=");
  CHECK(packed_numbers({0xFFFF}) == "u4://8AAA==");
  CHECK(packed_numbers({0x01020304}) == "u4:BAMCAQ==");
}

TEST_CASE("null is all ones in every width, and makes no number wider") {
  CHECK(packed_numbers({kNull, 3}) == "u1:/wM=");
  CHECK(packed_numbers({kNull, 300}) == "u2://8sAQ==");
  CHECK(packed_numbers({kNull, 70'000}) == "u4://///3ARAQA=");
}

TEST_CASE("floats are packed as their bits") {
  CHECK(report::packed(std::vector<float>{1.0F}) == "f4:AACAPw==");
}
