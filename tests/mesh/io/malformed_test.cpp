#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/mesh/io/encode.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

struct Case {
  std::string bytes;
  std::string start;  ///< of the message: file and line, or file and element
  std::string part;   ///< found or expected value
};

void check_all(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    const std::string name = c.start.substr(0, c.start.find(':'));
    const std::string message = error_of([&] { read_mesh(c.bytes, name); });
    CAPTURE(c.bytes.substr(0, 200));
    CAPTURE(message);
    CHECK(message.starts_with(c.start));
    CHECK(message.find(c.part) != std::string::npos);
    CHECK(message.find(", expected ") != std::string::npos);
    CHECK(message.find("; ") != std::string::npos);  // what to do
    CHECK(message.find('\n') == std::string::npos);
  }
}

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

std::string with_face(const std::string& face) {
  return kVertices + face + "\n";
}

std::string ply(const std::string& elements, const std::string& data) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + data;
}
const std::string kPlyVertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kPlyFace = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPlyPoints = "0 0 0\n1 0 0\n0 1 0\n";

std::string binary_ply(const std::string& vertex_count, const std::string& face_count,
                       const std::string& data) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + vertex_count +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + face_count +
         "\nproperty list uchar int vertex_indices\nend_header\n" + data;
}

}  // namespace

TEST_CASE("malformed OBJ files are rejected by line") {
  check_all({
      {"v 0 0 nan\n", "a.obj:1: ", "found 'nan', expected a finite number (coordinate z)"},
      {"v 0 0 0\nv inf 0 0\n", "a.obj:2: ", "found 'inf'"},
      {"v 0 0 0\nv -inf 0 0\n", "a.obj:2: ", "found '-inf'"},
      {"v 0 1e999 0\n", "a.obj:1: ", "found '1e999', expected a finite number (coordinate y)"},
      {"v 0 -1e999 0\n", "a.obj:1: ", "found '-1e999'"},
      {"v 0 0\n", "a.obj:1: ", "found the end of the line, expected a number (coordinate z)"},
      {"v 0 0", "a.obj:1: ", "found the end of the file, expected a number (coordinate z)"},
      {"v 0 0 0x10\n", "a.obj:1: ", "found '0x10', expected a number"},
      {"v 0 0 1,5\n", "a.obj:1: ", "found '1,5'"},
      {"v 0 0 1.5.2\n", "a.obj:1: ", "found '1.5.2'"},
      {"v 0 0 --1\n", "a.obj:1: ", "found '--1'"},
      {"v 0 0 +-1\n", "a.obj:1: ", "found '+-1'"},
      {"v 0 0 0 0 0\n", "a.obj:1: ", "found 5 numbers"},
      {"v 0 0 0 0 0 0 0 0\n", "a.obj:1: ", "found 8 numbers"},
      {"v 0 0 0 red\n", "a.obj:1: ", "found 'red'"},
      {with_face("f 1 2 0"), "a.obj:4: ", "vertex index 0 in '0', expected an index from 1"},
      {with_face("f 1 2 4"), "a.obj:4: ", "vertex index 4, expected at most 3"},
      {"f 1 2 4\n" + kVertices, "a.obj:1: ", "vertex index 4, expected at most 3"},
      {with_face("f 1 2 -4"), "a.obj:4: ", "vertex index -4, expected at least -3"},
      {"v 0 0 0\nf -1 -2 -3\nv 1 0 0\nv 0 1 0\n", "a.obj:2: ", "at least -1 (1 vertices so far)"},
      {with_face("f 1 2 4294967297"), "a.obj:4: ", "vertex index 4294967297"},
      {with_face("f 1 2 -4294967295"), "a.obj:4: ", "vertex index -4294967295"},
      {with_face("f 1 2 18446744073709551617"), "a.obj:4: ", "at most 64 bits"},
      {with_face("f 1 2 9223372036854775807"), "a.obj:4: ", "vertex index 9223372036854775807"},
      {with_face("f 1 2 -9223372036854775808"), "a.obj:4: ", "vertex index -9223372036854775808"},
      {with_face("f 1 2"), "a.obj:4: ", "a face with 2 corners, expected at least 3"},
      {with_face("f"), "a.obj:4: ", "a face with 0 corners"},
      {with_face("f 1 2 3.5"), "a.obj:4: ", "found '3.5', expected an integer"},
      {with_face("f 1 2 3/x"), "a.obj:4: ", "found 'x', expected an integer"},
      {with_face("f 1 2 3/1/1/1"), "a.obj:4: ", "expected v, v/vt, v//vn or v/vt/vn"},
      {with_face("f 1 2 /1"), "a.obj:4: ", "a face's vertex index"},
      {with_face("f 1 2 \\\n\\\n9 3"), "a.obj:6: ", "vertex index 9"},
      {with_face("l 1"), "a.obj:4: ", "a line with 1 corners, expected at least 2"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0.5\nl 1 2 3 1\n", "a.obj:3: ", "expected z = 0"},
      {kVertices, "a.obj: ", "found 3 vertices and no face"},
      {with_face("surf 0 1 0 1 1 2"), "a.obj:4: ", "free-form"},
      {with_face("face 1 2 3"), "a.obj:4: ", "found 'face', expected an OBJ statement"},
      {with_face("# fine\r\n\r\nf 1 2 7"), "a.obj:6: ", "vertex index 7"},
      {"v 0 0 0\nv 1 0" + std::string(1, '\0') + " 0\n", "a.obj:2: ", "a NUL byte (byte 13 of the file)"},
      {"v 0 0 \x1b[31m\n", "a.obj:1: ", "found '\\x1b[31m'"},
      {"v 0 0 " + std::string(5000, '7') + "x\n", "a.obj:1: ", "7...'"},
  });
}

TEST_CASE("malformed STL files are rejected by line, byte or triangle") {
  const std::string ascii = to_stl_ascii(tetrahedron());
  const std::string binary = to_stl_binary(tetrahedron());
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = ascii;
    return text.replace(text.find(from), from.size(), to);
  };
  std::string nan = binary, infinite = binary, claims = binary;
  nan.replace(84 + 50 + 12, 4, "\xff\xff\xff\x7f");
  infinite.replace(84 + 12 + 4, 4, std::string("\0\0\x80\xff", 4));
  claims.replace(80, 4, "\xff\xff\xff\xff");
  check_all({
      {ascii.substr(0, ascii.find("endsolid")),
       "a.stl:", "found the end of the file, expected 'facet or endsolid'"},
      {ascii.substr(0, ascii.find("endloop")), "a.stl:7: ", "found the end of the file, expected 'endloop'"},
      {ascii.substr(0, ascii.find("vertex") + 10), "a.stl:4: ", "found the end of the file"},
      {changed("endfacet", "facet"), "a.stl:8: ", "found 'facet', expected 'endfacet'"},
      {changed("endloop", "vertex 0 0 0\nendloop"), "a.stl:7: ", "found 'vertex', expected 'endloop'"},
      {changed("   vertex 0 0 0\n", ""), "a.stl:6: ", "found 'endloop', expected 'vertex'"},
      {changed("vertex 0 0 0", "vertex 0 nan 0"), "a.stl:4: ", "found 'nan', expected a finite number"},
      {changed("vertex 0 0 0", "vertex 0 zero 0"), "a.stl:4: ", "found 'zero', expected a number"},
      {changed("vertex 0 0 0", "vertex 0 1e400 0"), "a.stl:4: ", "found '1e400'"},
      {ascii + "trailing words\n", "a.stl:31: ", "found 'trailing', expected 'solid'"},
      {"solid empty\nendsolid empty\n", "a.stl: ", "no face"},
      {"solid", "a.stl:1: ", "found the end of the file"},
      {binary.substr(0, binary.size() - 1), "a.stl: ", "of 283 bytes, expected 284 for the 4 triangles"},
      {binary + std::string(50, 'x'), "a.stl: ", "of 334 bytes, expected 284"},
      {binary.substr(0, 50) + std::string(10, '\0'), "a.stl: ", "of 60 bytes, expected at least 84"},
      {claims, "a.stl: ", "expected 214748364834 for the 4294967295 triangles"},
      {nan, "a.stl: triangle 1 (byte 146): ", "found the coordinate nan"},
      {infinite, "a.stl: triangle 0 (byte 100): ", "found the coordinate inf"},
      {to_stl_binary(Mesh()), "a.stl: ", "no face"},
  });
}

TEST_CASE("malformed PLY headers are rejected by line") {
  const std::string both = kPlyVertex + kPlyFace;
  check_all({
      {"ply\n", "a.ply:2: ", "found the end of the file"},
      {"ply\nformat ascii 1.0\nelement vertex 3\n", "a.ply:4: ", "found the end of the file"},
      {"ply\n" + both + "end_header\n" + kPlyPoints, "a.ply:8: ", "no format statement"},
      {"ply\nformat ascii 2.0\n", "a.ply:2: ", "found PLY version '2.0'"},
      {"ply\nformat binary 1.0\n", "a.ply:2: ", "found format 'binary'"},
      {"ply\nformat ascii 1.0\nformat ascii 1.0\n", "a.ply:3: ", "a second format"},
      {"ply\nformat ascii 1.0\nelephant 3\n", "a.ply:3: ", "found 'elephant'"},
      {ply("property float x\n", ""), "a.ply:3: ", "a property before any element"},
      {ply("element vertex -3\n", ""), "a.ply:3: ", "found -3 elements"},
      {ply("element vertex many\n", ""), "a.ply:3: ", "found 'many', expected an integer"},
      {ply("element vertex 99999999999999999999\n", ""), "a.ply:3: ", "at most 64 bits"},
      {ply("element vertex\n", ""), "a.ply:3: ", "found the end of the line"},
      {ply("element vertex 1 2\n", ""), "a.ply:3: ", "found '2', expected the end of the line"},
      {ply(kPlyVertex + kPlyVertex, ""), "a.ply:7: ", "a second element 'vertex'"},
      {ply("element vertex 3\nproperty half x\n", ""), "a.ply:4: ", "found 'half', expected a type"},
      {ply("element vertex 3\nproperty float\n", ""), "a.ply:4: ", "the property's name"},
      {ply("element vertex 3\nproperty float x\nproperty float x\n", ""),
       "a.ply:5: ", "a second property 'x'"},
      {ply("element vertex 3\nproperty list float int x\n", ""), "a.ply:4: ", "whose length is a float"},
      {ply("element vertex 3\nproperty float x\nproperty float y\n" + kPlyFace, kPlyPoints),
       "a.ply:3: ", "a vertex without a number z"},
      {ply("element vertex 1\nproperty float x\nproperty float y\nproperty list int int z\n" + kPlyFace, ""),
       "a.ply:3: ", "a vertex without a number z"},
      {ply(kPlyFace, ""), "a.ply:5: ", "no element vertex"},
      {ply(kPlyVertex, kPlyPoints), "a.ply:7: ", "no element face"},
      {ply(kPlyVertex + "element face 1\nproperty int vertex_indices\n", kPlyPoints),
       "a.ply:7: ", "a face without a list of integers"},
      {ply(kPlyVertex + "element face 1\nproperty list uchar float vertex_indices\n", kPlyPoints),
       "a.ply:7: ", "a face without a list of integers"},
  });
}

TEST_CASE("malformed PLY data are rejected by line, or by byte and element") {
  const std::string both = kPlyVertex + kPlyFace;
  const std::string good = to_ply_binary(tetrahedron(), false);
  const std::size_t data = good.find("end_header") + 11;
  std::string nan = good, index = good, two = good;
  nan.replace(data + 24 + 8, 8, std::string("\0\0\0\0\0\0\xf8\x7f", 8));
  index.replace(good.size() - 4, 4, std::string("\4\0\0\0", 4));
  two[good.size() - 13] = 2;
  check_all({
      {ply(both, kPlyPoints), "a.ply:", "found the end of the file, expected another element"},
      {ply(both, kPlyPoints + "3 0\n"), "a.ply:13: ", "expected a value for 'vertex_indices'"},
      {ply(both, "0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), "a.ply:11: ", "expected a value for 'z'"},
      {ply(both, "0 0 0 5\n1 0 0\n0 1 0\n3 0 1 2\n"),
       "a.ply:10: ", "found '5', expected the end of the line"},
      {ply(both, "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n"),
       "a.ply:10: ", "found 'nan', expected a finite number (z)"},
      {ply(both, kPlyPoints + "3 0 1 3\n"), "a.ply:13: ", "vertex index 3, expected 0 to 2"},
      {ply(both, kPlyPoints + "3 0 1 -1\n"), "a.ply:13: ", "vertex index -1"},
      {ply(both, kPlyPoints + "3 0 1 4294967296\n"), "a.ply:13: ", "vertex index 4294967296"},
      {ply(both, kPlyPoints + "2 0 1\n"), "a.ply:13: ", "a face with 2 corners"},
      {ply(both, kPlyPoints + "-3 0 1 2\n"), "a.ply:13: ", "a face with -3 corners"},
      {ply(both, kPlyPoints + "4000000000 0 1 2\n"), "a.ply:13: ", "a value for 'vertex_indices'"},
      {ply(both, kPlyPoints + "3 0 1 2\n3 0 1 2\n"), "a.ply:14: ", "expected the end of the file"},
      {ply("element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n" + kPlyFace,
           kPlyPoints),
       "a.ply:", "fewer bytes than 4000000000 times 'vertex' need"},
      {ply("element vertex 9223372036854775807\nproperty float x\nproperty float y\nproperty float z\n" +
               kPlyFace,
           ""),
       "a.ply:", "fewer bytes than 9223372036854775807 times 'vertex' need"},
      {binary_ply("4000000000", "1", "abc"), "a.ply: byte ", "fewer bytes than 4000000000 times 'vertex'"},
      {binary_ply("0", "4000000000", "abc"), "a.ply: byte ", "fewer bytes than 4000000000 times 'face'"},
      {binary_ply("1", "0", std::string(12, '\0')), "a.ply: ", "no face"},
      {binary_ply("1", "1", std::string(12, '\0') + "\xff" + std::string(40, '\0')), "a.ply: byte ",
       "'face' 0: found the end of the file, expected a value for 'vertex_indices'"},
      {good.substr(0, good.size() - 1), "a.ply: byte ", "'face' 3: found the end of the file"},
      {good + "x", "a.ply: byte " + std::to_string(good.size()), "found 1 bytes more than the header says"},
      {nan, "a.ply: byte " + std::to_string(data + 40) + ", 'vertex' 1: ", "found nan, expected a finite"},
      {index,
       "a.ply: byte " + std::to_string(good.size()) + ", 'face' 3: ", "vertex index 4, expected 0 to 3"},
      {two, "a.ply: byte ", "'face' 3: found a face with 2 corners"},
  });
}

TEST_CASE("malformed OFF files are rejected by line") {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  check_all({
      {"OFF\n", "a.off:2: ", "found the end of the file, expected an integer (the number of vertices)"},
      {"OFF\n3\n", "a.off:2: ", "the number of faces"},
      {"OFF\n3 1 x\n", "a.off:2: ", "found 'x'"},
      {"OFF\n3 1 0 0\n", "a.off:2: ", "found '0', expected the end of the line of counts"},
      {"OFF\n-1 1 0\n", "a.off:2: ", "found '-1', expected 0 or more"},
      {"OFF\n4000000000 1 0\n" + points, "a.off:2: ", "counts of 4000000000 vertices and 1 faces"},
      {"OFF\n3 4000000000 0\n" + points, "a.off:2: ", "counts of 3 vertices and 4000000000 faces"},
      {"OFF\n9223372036854775807 9223372036854775807 0\n", "a.off:2: ", "counts of 9223372036854775807"},
      {"OFF\n3 1 0\n0 0 0\n1 0 0\n# lost, lost, lost, lost, lost\n", "a.off:6: ", "expected another vertex"},
      {"OFF\n3 1 0\n" + points + "# lost, lost, lost, lost, lost\n", "a.off:7: ", "expected another face"},
      {"OFF\n3 1 0\n" + points + "3 0 1 3\n", "a.off:6: ", "vertex index 3, expected 0 to 2"},
      {"OFF\n3 1 0\n" + points + "3 0 1 -1\n", "a.off:6: ", "vertex index -1"},
      {"OFF\n3 1 0\n" + points + "2 0 1    \n", "a.off:6: ", "a face with 2 corners"},
      {"OFF\n3 1 0\n" + points + "4000000000 0 1 2\n", "a.off:6: ", "found the end of the line"},
      {"OFF\n3 1 0\n" + points + "3 0 1 2\n3 0 1 2\n", "a.off:7: ", "expected the end of the file"},
      {"OFF\n3 1 0\n0 0 0 9\n1 0 0\n0 1 0\n3 0 1 2\n", "a.off:3: ", "colours need the header COFF"},
      {"OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "a.off:3: ", "coordinate z"},
      {"OFF\n3 1 0\n0 inf 0\n1 0 0\n0 1 0\n3 0 1 2\n", "a.off:3: ", "found 'inf'"},
      {"OFF\n3 1 0\n" + points + "3 0 1 2 red\n", "a.off:6: ", "found 'red'"},
      {"4OFF\n3 1 0\n", "a.off:1: ", "found the header '4OFF'"},
      {"nOFF\n3\n3 1 0\n", "a.off:1: ", "found the header 'nOFF'"},
      {"OFF BINARY\n", "a.off:1: ", "a binary OFF file"},
      {"OFF\n0 0 0\n", "a.off: ", "no face"},
  });
}

TEST_CASE("files of other kinds are rejected with their apparent format") {
  check_all({
      {"", "a.obj:1: ", "an empty file"},
      {" \r\n\n\t ", "a.ply:1: ", "only white space"},
      {"# only\n# comments\n", "a.obj:1: ", "only comments"},
      {"<!DOCTYPE html>\n<html>\n", "a.obj:1: ", "an HTML page"},
      {"\n  <HTML><body>404</body>", "a.stl:1: ", "an HTML page"},
      {"<?xml version=\"1.0\"?>", "a.ply:1: ", "XML"},
      {"version https://git-lfs.github.com/spec/v1\n", "a.obj:1: ", "Git LFS"},
      {std::string("\xff\xfev\0 \0", 6), "a.obj:1: ", "UTF-16"},
      {std::string("v\0 \0000\0", 6), "a.obj:1: ", "UTF-16"},
      {std::string("\0v\0 \0000", 6), "a.obj:1: ", "UTF-16"},
      {"PK\3\4rest", "a.obj:1: ", "ZIP"},
      {"\x1f\x8b\x08", "a.ply:1: ", "gzip"},
      {"glTF\2", "a.obj:1: ", "glTF"},
      {"{\"asset\":{}}", "a.off:1: ", "JSON"},
      {"\x89PNG\r\n", "a.obj:1: ", "PNG"},
      {std::string(100, '\0'), "a.ply:1: ", "binary data of an unknown format"},
      {"Dear reader,\n", "a.txt:1: ", "text that begins with 'Dear'"},
      {"Dear reader,\n", "a.obj:1: ", "found 'Dear', expected an OBJ statement"},
  });
  CHECK(error_of([] { read_mesh("v 0 0 x", "new\nline.obj"); }).starts_with("new\\x0aline.obj:1: found 'x'"));
}

TEST_CASE("a truncated file is rejected, or read if its format cannot tell") {
  const Mesh body = tetrahedron();
  for (const std::string& whole : {to_stl_ascii(body), to_stl_binary(body), to_ply_binary(body, false),
                                   to_off(body), to_ply_ascii(body)}) {
    const std::size_t needed = whole.find_last_not_of("\n") + 1;  // the last newline may be missing
    for (std::size_t size = 0; size < needed; ++size) {
      const std::string message = error_of([&] { read_mesh(whole.substr(0, size), "cut"); });
      CAPTURE(size);
      // "endsolid body" without the end of its name is still the end.
      if (message.empty()) CHECK(whole.substr(0, size).find("endsolid") != std::string::npos);
      CHECK(message.find('\n') == std::string::npos);
    }
  }
}

}  // namespace lrb::test
