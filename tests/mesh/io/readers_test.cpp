#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "engine/mesh/io/formats.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/mesh/io/encode.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::test {

using namespace shapes;
namespace {

void check_same(const Mesh& a, const Mesh& b) {
  CHECK(a.dim == b.dim);
  CHECK(a.vertices == b.vertices);
  CHECK(a.face_offsets == b.face_offsets);
  CHECK(a.face_vertices == b.face_vertices);
}

/// Faces as coordinates, for formats that have no vertex indices.
std::vector<Eigen::Vector3d> corner_points(const Mesh& m) {
  std::vector<Eigen::Vector3d> points;
  for (const VertexId v : m.face_vertices) points.push_back(m.vertices[v]);
  return points;
}

const std::string kFourVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

std::vector<VertexId> obj_corners(const std::string& faces) {
  return read_mesh(kFourVertices + faces, "t.obj").face_vertices;
}

}  // namespace

TEST_CASE("OBJ: every form of index") {
  const std::vector<VertexId> expected = {0, 2, 1};
  for (const char* face : {"f 1 3 2", "f 1/1 3/7 2/2", "f 1//1 3//7 2//2", "f 1/4/1 3/5/7 2/6/2",
                           "f -4 -2 -3", "f -4/-1 -2/-1 -3/-1", "f -4//-1 -2//-1 -3//-1", "f -4/1/2 3 -3//1",
                           "f +1 +3 +2", "f 1/ 3/ 2/", "f 1// 3// 2//", "fo 1 3 2", "\tf\t1  3 \t2  ",
                           "f 1 3 2 # last one", "f 1 \\\n3 \\\r\n2", "f 1 3\\\n 2", "f 1 3 \\\r2"}) {
    CAPTURE(face);
    CHECK(obj_corners(face) == expected);
    CHECK(obj_corners(std::string(face) + "\n") == expected);
  }
  CHECK(read_mesh("f 1 3 2\n" + kFourVertices, "t.obj").face_vertices == expected);
}

TEST_CASE("OBJ: negative indices count from the vertex before the face") {
  const Mesh m = read_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -4 -1 -3\n", "t.obj");
  CHECK(m.face_vertices == std::vector<VertexId>{0, 1, 2, 0, 3, 1});
}

TEST_CASE("OBJ: weights, colours, groups, materials and comments are ignored") {
  const Mesh m = read_mesh(
      "\xef\xbb\xbf# a comment that ends with a backslash \\\nmtllib a.mtl\no thing\ng one two\ns off\n"
      "v 1e0 2. -.5 1.0\nv 0 0 0 0.1 0.2 0.3\nv 0 1 0 0.1 0.2 0.3 1\nvn 0 0 1\nvt 0.5\nusemtl red\n\n"
      "   \nf 1 2 3\np 1\nl 1 2\n#end",
      "t.obj");
  CHECK(m.dim == 3);
  CHECK(m.face_count() == 1);
  CHECK(m.vertices[0] == Eigen::Vector3d(1, 2, -0.5));
  CHECK(m.name == "t.obj");
}

TEST_CASE("OBJ: lines end with LF, CR LF or CR") {
  const Mesh unix_lines = read_mesh(kFourVertices + "f 1 2 3\nf 1 2 4\n", "t.obj");
  for (const char* end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : kFourVertices + "f 1 2 3\nf 1 2 4\n") c == '\n' ? text += end : text += c;
    check_same(read_mesh(text, "t.obj"), unix_lines);
  }
}

TEST_CASE("OBJ: numbers are rounded to the nearest double, also below the smallest normal one") {
  const Mesh m = read_mesh(
      "v 0.1 1e-400 -1e-400\nv 4.9406564584124654e-324 1e-310 1.7976931348623157e308\nv 0 1 0\n"
      "f 1 2 3\n",
      "t.obj");
  CHECK(m.vertices[0] == Eigen::Vector3d(0.1, 0, 0));
  CHECK(std::signbit(m.vertices[0].z()));
  CHECK(m.vertices[1].x() == std::numeric_limits<double>::denorm_min());
  CHECK(m.vertices[1].y() == 1e-310);
  CHECK(m.vertices[1].z() == std::numeric_limits<double>::max());
}

TEST_CASE("OBJ: polylines without faces are a 2D body") {
  const Mesh m = read_mesh(
      "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 0\nv 1 2 0\nv 2 1 0\nl 1 2 3 1\nl 4 5\nl 5 6\nl -1 -3\n", "t.obj");
  CHECK(m.dim == 2);
  CHECK(m.face_vertices == std::vector<VertexId>{0, 1, 1, 2, 2, 0, 3, 4, 4, 5, 5, 3});
  const MeshReport report = check_mesh(m);
  CHECK(report.closed);
  CHECK(report.components == 2);
  CHECK(report.lines(m).empty());
}

TEST_CASE("STL ASCII: several solids, any case, any normal, equal vertices merged") {
  const Mesh body = tetrahedron();
  std::string text =
      to_stl_ascii(body, "a name with words") + "\n" + to_stl_ascii(translated(body, {1, 0, 0}), "");
  text.replace(text.find("facet normal 0 0 0"), 18, "FACET Normal nan inf -nan(ind)");
  const Mesh m = read_mesh(text, "t.stl");
  CHECK(m.face_count() == 8);
  CHECK(m.vertices.size() == 7);  // they share the corner (1, 0, 0)
  CHECK(corner_points(m) == corner_points(several({body, translated(body, {1, 0, 0})})));
}

TEST_CASE("STL: 0 and -0 are one coordinate, numbers an ulp apart are two") {
  Mesh m = tetrahedron();
  std::string text = to_stl_ascii(m);
  text.replace(text.find("vertex 0 0 0"), 12, "vertex -0 0 -0.0");
  CHECK(read_mesh(text, "t.stl").vertices.size() == 4);
  text.replace(text.find("vertex 1 0 0"), 12, "vertex " + digits(std::nextafter(1, 2)) + " 0 0");
  CHECK(read_mesh(text, "t.stl").vertices.size() == 5);
}

TEST_CASE("STL binary: recognised by its size, whatever its header") {
  const Mesh body = icosphere(2);
  for (const char* header : {"exported by something", "solid ", "solid name\nfacet normal", ""}) {
    const Mesh m = read_mesh(to_stl_binary(body, header), "t.stl");
    CHECK(m.face_count() == body.face_count());
    CHECK(m.vertices.size() == body.vertices.size());
    CHECK(check_mesh(m).closed);
  }
  CHECK(read_mesh(to_stl_binary(body, "solid"), "misnamed.obj").face_count() == body.face_count());
}

TEST_CASE("STL: a text without line breaks, and binary data with other data after them") {
  std::string line = to_stl_ascii(tetrahedron());
  std::replace(line.begin(), line.end(), '\n', ' ');
  const Mesh body = read_mesh(to_stl_ascii(tetrahedron()), "t.stl");
  check_same(read_mesh(line, "t.stl"), body);
  check_same(read_mesh(to_stl_binary(tetrahedron()) + "appended", "t.stl"), body);
}

TEST_CASE("PLY: any order and type of properties, other elements and lists skipped") {
  const Mesh m = read_mesh(
      "ply\nformat ascii 1.0\ncomment c\nobj_info o\nelement material 2\nproperty uchar red\nproperty list "
      "uchar float w\n"
      "element vertex 4\nproperty uchar red\nproperty float64 z\nproperty list int double weights\nproperty "
      "short x\n"
      "property float y\nelement nothing 3\nelement face 2\nproperty list uint8 uint8 flags\n"
      "property list ushort uint32 vertex_index\nproperty int group\nelement edge 1\nproperty int vertex1\n"
      "property int vertex2\nend_header\n"
      "7 0\n8 2 0.5 0.5\n"
      "255 0 0 0 0\n255 0 1 0.5 1 0\n\n255 0 0 0 1\n255 1 2 0.5 0.5 0 0\n"
      "0 3 0 1 2 4\n2 9 9 4 0 1 2 3 5\n0 1\n",
      "t.ply");
  CHECK(m.vertices == std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  CHECK(m.face_offsets == std::vector<std::uint32_t>{0, 3, 7});
  CHECK(m.face_vertices == std::vector<VertexId>{0, 1, 2, 0, 1, 2, 3});
}

TEST_CASE("PLY binary: both endians, all types, other elements and lists skipped") {
  for (const bool big : {false, true}) {
    std::string bytes =
        std::string("ply\r\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
        " 1.0\r\nelement camera 1\r\nproperty double f\r\nproperty list uchar short s\r\n"
        "element vertex 3\r\nproperty int8 z\r\nproperty list uint16 float w\r\nproperty int x\r\n"
        "property ushort y\r\nelement face 1\r\nproperty uchar a\r\n"
        "property list int32 uint8 vertex_indices\r\nproperty list char double d\r\nend_header\r\n";
    put(bytes, 1.5, big);
    bytes += '\2';
    put(bytes, std::int16_t{1}, big);
    put(bytes, std::int16_t{2}, big);
    for (int i = 0; i < 3; ++i) {
      bytes += static_cast<char>(-i);
      put(bytes, static_cast<std::uint16_t>(i), big);
      for (int k = 0; k < i; ++k) put(bytes, 1.0f, big);
      put(bytes, std::int32_t{-70000 * i}, big);
      put(bytes, static_cast<std::uint16_t>(i == 1 ? 65535 : 0), big);
    }
    bytes += '\7';
    put(bytes, std::int32_t{3}, big);
    bytes += std::string("\0\1\2\1", 4);
    put(bytes, 2.5, big);
    const Mesh m = read_mesh(bytes, "t.ply");
    CHECK(m.vertices == std::vector<Eigen::Vector3d>{{0, 0, 0}, {-70000, 65535, -1}, {-140000, 0, -2}});
    CHECK(m.face_vertices == std::vector<VertexId>{0, 1, 2});
  }
}

TEST_CASE("PLY binary: a header with CR lines, and data that begin with a line feed's byte") {
  std::string bytes = to_ply_binary(tetrahedron(), false);
  const std::size_t data = bytes.find("end_header") + 11;
  std::string header = bytes.substr(0, data);
  for (char& c : header)
    if (c == '\n') c = '\r';
  bytes.replace(0, data, header);
  bytes[data] = '\n';  // the last bits of the first x
  const Mesh m = read_mesh(bytes, "t.ply");
  CHECK(m.vertices[0].x() == 10 * std::numeric_limits<double>::denorm_min());
  CHECK(m.face_count() == 4);
}

TEST_CASE("OFF: keyword forms, comments, colours, counts on the keyword's line") {
  const Mesh body = tetrahedron();
  const std::string off = to_off(body);
  check_same(read_mesh(off, "t.off"), body);
  check_same(read_mesh("# first\n\nOFF # keyword\n# counts\n4 4 6 # these\n" + off.substr(10), "t.off"),
             body);
  check_same(read_mesh("OFF 4 4 0\n" + off.substr(10), "t.off"), body);
  check_same(read_mesh("OFF4 4 0\n" + off.substr(10), "t.off"), body);
  check_same(read_mesh("OFF\n4 4\n" + off.substr(10), "t.off"), body);
  check_same(read_mesh(off.substr(4), "t.off"), body);  // the keyword may be left out
  std::string coloured = "COFF\n4 4 0\n";
  for (const auto& v : body.vertices)
    coloured += digits(v.x()) + " " + digits(v.y()) + " " + digits(v.z()) + " 255 0 0 255\n";
  coloured += "3 0 2 1 255 0 0\n3 0 1 3 0.5 0.5 0.5 1.0\n3 0 3 2 7\n3 1 2 3\n";
  check_same(read_mesh(coloured, "t.off"), body);
  coloured.replace(0, 4, "NOFF");
  check_same(read_mesh(coloured, "t.off"), body);
}

TEST_CASE("content decides, not the extension") {
  const Mesh body = tetrahedron();
  const std::string obj = kFourVertices + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  for (const char* name : {"a.obj", "a.stl", "a.ply", "a.off", "a.txt", "a", ""}) {
    CAPTURE(name);
    check_same(read_mesh(obj, name), body);
    check_same(read_mesh(to_off(body), name), body);
    check_same(read_mesh(to_ply_ascii(body), name), body);
    check_same(read_mesh(to_ply_binary(body, true), name), body);
    CHECK(corner_points(read_mesh(to_stl_ascii(body), name)) == corner_points(body));
    CHECK(corner_points(read_mesh(to_stl_binary(body), name)) == corner_points(body));
  }
}

TEST_CASE("the usual extensions of meshes, in any case") {
  for (const char* name : {"a.obj", "b.c/A.STL", "a.ply", ".x.Off"}) CHECK(has_mesh_extension(name));
  for (const char* name : {"a.lrb", "a.obj.gz", "obj", "", "a.obj/b"}) CHECK_FALSE(has_mesh_extension(name));
}

TEST_CASE("round trips through files keep every bit") {
  const Folder directory;
  for (const Mesh& body :
       {bumpy_sphere(2, 7), quad_torus(9, 7), tetrahedron(1e-300), scaled(torus(5, 4), 1e150)}) {
    for (const char* name : {"m.obj", "m.PLY"}) {
      const std::string path = directory / name;
      write_mesh(body, path);
      check_same(read_mesh(path), body);
    }
    check_same(read_mesh(to_off(body), "m.off"), body);
    check_same(read_mesh(to_ply_ascii(body), "m.ply"), body);
    check_same(read_mesh(to_ply_binary(body, true), "m.ply"), body);
    check_same(read_mesh(to_ply_binary(body, false), "m.ply"), body);
  }
  const Mesh flat = ring_2d(12);
  write_mesh(flat, directory / "flat.obj");
  check_same(read_mesh(directory / "flat.obj"), flat);
  CHECK(directory.tree().size() == 3);  // no temporary file is left
}

TEST_CASE("PLY with a polygon of more than 255 corners, and with colours") {
  const Folder directory;
  Mesh disk = circle(300);
  disk.dim = 3;
  disk.face_offsets = {0};
  disk.face_vertices.clear();
  std::vector<VertexId> corners(300);
  for (VertexId v = 0; v < 300; ++v) corners[v] = v;
  disk.add_face(corners);
  write_mesh(disk, directory / "disk.ply");
  check_same(read_mesh(directory / "disk.ply"), disk);

  const std::vector<FaceColour> colours(4, {255, 128, 0});
  write_mesh(tetrahedron(), directory / "colours.ply", colours);
  check_same(read_mesh(directory / "colours.ply"), tetrahedron());
  CHECK(load_bytes(directory / "colours.ply").ends_with("\xff\x80" + std::string(1, '\0')));
  CHECK_THROWS_AS(write_mesh(disk, directory / "x.ply", colours), InputError);
  CHECK_THROWS_AS(write_mesh(disk, directory / "x.stl"), InputError);
  CHECK_THROWS_AS(write_mesh(circle(5), directory / "x.ply"), InputError);
}

}  // namespace lrb::test
