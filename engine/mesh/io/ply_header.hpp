#pragma once
/// The header of a PLY file, which says what its data consists of.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lrb {

enum class PlyFormat : std::uint8_t { ascii, binary_little_endian, binary_big_endian };
enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

std::size_t size_of(PlyType type);
constexpr bool is_integer(PlyType type) {
  return type < PlyType::f32;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;
  std::optional<PlyType> count_type;  ///< for a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t line = 0;  ///< line of the header
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t data_offset = 0;  ///< number of bytes before the data
  std::uint64_t data_line = 0;  ///< line on which the data begins
};

/// Reads the header. Throws InputError naming the line.
PlyHeader read_ply_header(std::string_view bytes, std::string_view name);

}  // namespace lrb
