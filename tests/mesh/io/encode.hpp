#pragma once
/// Meshes as the bytes of files, encoded without the engine, as input for the readers.

#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>

#include <lrbscope/mesh.hpp>

namespace lrb::test {

inline std::string digits(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

template <class T>
void put(std::string& out, T value, bool big_endian = false) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  const bool turn = big_endian == (std::endian::native == std::endian::little);
  for (std::size_t i = 0; i < sizeof(T); ++i) out += bytes[turn ? sizeof(T) - 1 - i : i];
}

inline std::string to_off(const Mesh& m) {
  std::string out =
      "OFF\n" + std::to_string(m.vertices.size()) + " " + std::to_string(m.face_count()) + " 0\n";
  for (const auto& v : m.vertices) out += digits(v.x()) + " " + digits(v.y()) + " " + digits(v.z()) + "\n";
  for (FaceId f = 0; f < m.face_count(); ++f) {
    out += std::to_string(m.face(f).size());
    for (const VertexId v : m.face(f)) out += " " + std::to_string(v);
    out += "\n";
  }
  return out;
}

inline std::string ply_header(const Mesh& m, const std::string& format, const std::string& real) {
  return "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " +
         std::to_string(m.vertices.size()) + "\nproperty " + real + " x\nproperty " + real + " y\nproperty " +
         real + " z\nelement face " + std::to_string(m.face_count()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string to_ply_ascii(const Mesh& m) {
  std::string out = ply_header(m, "ascii", "double");
  const std::string off = to_off(m);
  return out + off.substr(off.find('\n', 4) + 1);  // the bodies are alike
}

inline std::string to_ply_binary(const Mesh& m, bool big_endian, bool doubles = true) {
  std::string out =
      ply_header(m, big_endian ? "binary_big_endian" : "binary_little_endian", doubles ? "double" : "float");
  for (const auto& v : m.vertices)
    for (const double x : v) {
      if (doubles)
        put(out, x, big_endian);
      else
        put(out, static_cast<float>(x), big_endian);
    }
  for (FaceId f = 0; f < m.face_count(); ++f) {
    out += static_cast<char>(m.face(f).size());
    for (const VertexId v : m.face(f)) put(out, static_cast<std::int32_t>(v), big_endian);
  }
  return out;
}

inline std::string to_stl_ascii(const Mesh& m, const std::string& name = "body") {
  std::string out = "solid " + name + "\n";
  for (FaceId f = 0; f < m.face_count(); ++f) {
    out += " facet normal 0 0 0\n  outer loop\n";
    for (const VertexId v : m.face(f))
      out += "   vertex " + digits(m.vertices[v].x()) + " " + digits(m.vertices[v].y()) + " " +
             digits(m.vertices[v].z()) + "\n";
    out += "  endloop\n endfacet\n";
  }
  return out + "endsolid " + name + "\n";
}

inline std::string to_stl_binary(const Mesh& m, const std::string& header = "binary") {
  std::string out = header;
  out.resize(80, ' ');
  put(out, static_cast<std::uint32_t>(m.face_count()));
  for (FaceId f = 0; f < m.face_count(); ++f) {
    for (int i = 0; i < 3; ++i) put(out, 0.0f);
    for (const VertexId v : m.face(f))
      for (const double x : m.vertices[v]) put(out, static_cast<float>(x));
    put(out, std::uint16_t{0});
  }
  return out;
}

inline void save(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string load_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace lrb::test
