#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/support/text.hpp"
#include "tests/trace/captures.hpp"
#include <lrbscope/error.hpp>

namespace lrb::capture {
namespace {

/// Reads a capture as a stream, in pieces of the given size. Returns its ended queries.
std::vector<Query> stream_queries(const Bytes& bytes, std::size_t piece, Stream& stream) {
  std::vector<Query> out;
  for (std::size_t at = 0; at < bytes.size(); at += piece)
    stream.feed(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)),
                [&](Query query) { out.push_back(std::move(query)); });
  return out;
}

/// Returns the message with which a capture is refused. A stream must refuse it with the same one, except
/// that it waits for the rest of a header, and no longer has the queries that ended.
std::string refusal(const Bytes& bytes) {
  Stream stream("run.lrbcap");
  const std::string in_stream = test::error_of([&] { stream_queries(bytes, 7, stream); }),
                    out = test::error_of([&] { read(bytes); });
  bool excused = bytes.size() < 16;
  for (const char* of_ended : {"a second time", "after the end of their query"})
    excused = excused || out.find(of_ended) != std::string::npos;
  if (!excused) CHECK(in_stream == out);
  return out;
}

/// A tree of spheres in floats, whose nodes have ids.
std::uint32_t a_tree_with_ids() {
  lrbcap_tree tree = shape_of_tree(a_mesh());
  tree.volume = LRBCAP_SPHERE;
  tree.volumes = nullptr;
  tree.float_volumes = kSpheres;
  tree.ids = kIds;
  return LRBCAP_TREE(&tree);
}

/// Two trees, a name and a query of six events.
void a_query() {
  const std::uint32_t a = a_tree(), b = a_tree_with_ids(), name = LRBCAP_NAME("cache hits");
  LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a, nullptr, b, kPose);
  LRBCAP_PHASE(name);
  LRBCAP_NODE(0, 30, 7, LRBCAP_NO_AXIS);  // any number but 0 is a hit
  LRBCAP_NODE(1, 20, 0, 9);
  LRBCAP_NODES(2, 10, 4, 3, LRBCAP_NO_AXIS);
  LRBCAP_PRIM(3, 1, 1);
  LRBCAP_COUNT(name, 4000000000);
  LRBCAP_END(LRBCAP_INTERSECTING, 1);
}

// Damage. Chunks are named by kind and number, their content by offset.

constexpr std::size_t kFileHeader = 16, kHeader = 24;

std::uint64_t size_of_chunk(const Bytes& bytes, std::size_t at) {
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data() + at + 8, 8);
  return size;
}
/// Returns where each chunk begins, and the end.
std::vector<std::size_t> chunks_of(const Bytes& bytes) {
  std::vector<std::size_t> out{kFileHeader};
  while (out.back() + kHeader <= bytes.size())
    out.push_back(out.back() + kHeader + size_of_chunk(bytes, out.back()));
  return out;
}
std::size_t find_chunk(const Bytes& bytes, const char* kind, int n = 0) {
  for (const std::size_t at : chunks_of(bytes))
    if (at < bytes.size() && std::memcmp(bytes.data() + at, kind, 4) == 0 && n-- == 0) return at;
  FAIL("no chunk " << kind);
  return 0;
}
template <class Number>
Bytes with(Bytes bytes, const char* kind, std::size_t offset, Number value, int n = 0) {
  std::memcpy(bytes.data() + (find_chunk(bytes, kind, n) + kHeader + offset), &value, sizeof value);
  return bytes;
}
Bytes without(Bytes bytes, const char* kind, int n = 0) {
  const std::size_t at = find_chunk(bytes, kind, n), size = kHeader + size_of_chunk(bytes, at);
  bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at),
              bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
  return bytes;
}
Bytes twice(Bytes bytes, const char* kind, int n = 0) {
  const std::size_t at = find_chunk(bytes, kind, n), size = kHeader + size_of_chunk(bytes, at);
  const Bytes copy(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                   bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), copy.begin(), copy.end());
  return bytes;
}
/// Inserts a chunk before the last.
Bytes with_chunk(Bytes bytes, const std::string& kind, std::uint32_t version, const std::string& content) {
  std::string chunk = kind;
  const std::uint64_t size = content.size(), ticks = 0;
  chunk.append(reinterpret_cast<const char*>(&version), 4);
  chunk.append(reinterpret_cast<const char*>(&size), 8);
  chunk.append(reinterpret_cast<const char*>(&ticks), 8);
  chunk += content;
  const auto* from = reinterpret_cast<const std::byte*>(chunk.data());
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(find_chunk(bytes, "STOP")), from,
               from + chunk.size());
  return bytes;
}

void contains(const std::string& message, const std::vector<std::string>& parts) {
  CAPTURE(message);
  CHECK(message.starts_with("run.lrbcap:"));
  CHECK(message.find('\n') == std::string::npos);
  for (const std::string& part : parts) {
    CAPTURE(part);
    CHECK(message.find(part) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("a capture reads back what an engine reported") {
  const Capture c = read(record(a_query));
  CHECK(c.engine == "engine 1");
  CHECK(c.names == std::vector<std::string>{"cache hits"});
  // Terminals and pages show names.
  CHECK(read(with(record(a_query), "HEAD", 0, '\x1b')).engine == "\\x1bngine 1");
  CHECK(read(with(record(a_query), "NAME", 4, '\n')).names[0] == "\\x0aache hits");
  CHECK(read(with(record(a_query), "MESH", 16, '\x1b', 1)).meshes[1].name == "\\x1bedge");
  CHECK_FALSE(c.cut_off);
  REQUIRE(c.meshes.size() == 2);
  CHECK(c.meshes[1].name == "wedge");
  REQUIRE(c.meshes[1].vertices.size() == 4);
  CHECK(c.meshes[1].vertices[3] == Eigen::Vector3d(0, 0, 1));
  REQUIRE(c.meshes[1].triangles.size() == 4);
  CHECK(c.meshes[1].triangles[2] == std::array<std::uint32_t, 3>{1, 2, 3});

  REQUIRE(c.trees.size() == 2);
  const Tree &boxes = c.trees[0], &spheres = c.trees[1];
  CHECK(boxes.size() == 3);
  CHECK(boxes.volume == VolumeKind::aabb);
  CHECK(boxes.volumes == std::vector<double>(std::begin(kBoxes), std::end(kBoxes)));
  CHECK(boxes.children(0)[1] == 2);
  CHECK(boxes.triangles(2)[0] == 2);
  CHECK(boxes.is_leaf(1));
  CHECK(boxes.id_of(2) == 2);
  CHECK(spheres.mesh == 1);
  CHECK(spheres.volume == VolumeKind::sphere);
  CHECK(spheres.volume_of(2)[3] == 3.0);
  CHECK(spheres.id_of(0) == 30);

  REQUIRE(c.queries.size() == 1);
  const Query& q = c.queries[0];
  CHECK(q.number == 1);
  CHECK(q.kind == QueryKind::all_pairs);
  CHECK(q.trees == std::array<std::uint32_t, 2>{0, 1});
  CHECK(q.poses[0].r.isIdentity(0));
  CHECK(q.poses[1].r(0, 1) == -1);
  CHECK(q.poses[1].t == Eigen::Vector3d(4, 5, 6));
  CHECK(q.ended);
  CHECK(q.verdict == Verdict::intersecting);
  CHECK(q.pairs == 1);
  CHECK(q.events_seen == 6);
  CHECK(q.complete());
  CHECK(q.duration_ns >= 0);
  CHECK(q.events == std::vector<Event>{{0, 0, EventKind::phase, 0, 1, 255},
                                       {0, 0, EventKind::nodes, 1, 1, 255},
                                       {1, 2, EventKind::nodes, 0, 1, 9},
                                       {2, 1, EventKind::nodes, 3, 4, 255},
                                       {3, 1, EventKind::triangles, 1, 1, 255},
                                       {0, 4000000000, EventKind::count, 0, 1, 255}});
}

TEST_CASE("any numbers of any length read back, across buffers") {
  std::mt19937 random(1);
  std::vector<Event> reported;
  for (int i = 0; i < 30000; ++i) {
    const auto a = static_cast<std::uint32_t>(random() >> random() % 32);
    const auto b = static_cast<std::uint32_t>(random() >> random() % 32);
    const auto tests = static_cast<std::uint8_t>(1 + random() % 3 * 100);
    reported.push_back({a, b, static_cast<EventKind>(random() % 2),
                        static_cast<std::uint8_t>(random() % (tests + 1)), tests,
                        static_cast<std::uint8_t>(random() % 2 ? 255 : random() % 15)});
    if (reported.back().kind == EventKind::triangles)
      reported.back().tests = 1, reported.back().met %= 2, reported.back().axis = 255;
  }
  const Capture c = read(record([&] {
    LRBCAP_BEGIN(LRBCAP_ANY, 0, nullptr, 0, nullptr);  // shapes without trees
    for (const Event& e : reported)
      if (e.kind == EventKind::nodes)
        LRBCAP_NODES(e.a, e.b, e.tests, e.met, e.axis);
      else
        LRBCAP_PRIM(e.a, e.b, e.met);
    LRBCAP_END(LRBCAP_UNREPORTED, 0);
  }));
  CHECK(c.queries.at(0).events == reported);
  CHECK(c.queries[0].complete());
  CHECK(c.queries[0].trees == std::array<std::uint32_t, 2>{kNull, kNull});
  CHECK(c.queries[0].verdict == Verdict::unreported);
}

TEST_CASE("trees of every volume are read, and a tree may replace another") {
  const std::vector<double> numbers(3 * 12, 0.5);
  const double directions[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
  const Capture c = read(record([&] {
    const std::uint32_t mesh = a_mesh();
    std::uint32_t before = 0;
    for (const std::uint32_t volume : {LRBCAP_AABB, LRBCAP_SPHERE, LRBCAP_OBB, LRBCAP_RSS, LRBCAP_KDOP}) {
      lrbcap_tree tree = shape_of_tree(mesh);
      tree.replaces = before;
      tree.volume = volume == LRBCAP_OBB ? volume | LRBCAP_SPLITS : volume;
      tree.volumes = numbers.data();
      tree.directions = volume == LRBCAP_KDOP ? 4 : 0;
      tree.direction = directions;
      before = LRBCAP_TREE(&tree);
    }
  }));
  REQUIRE(c.trees.size() == 5);
  const std::size_t per_node[] = {6, 4, 12, 10, 8};
  for (std::uint32_t i = 0; i < 5; ++i) {
    CHECK(c.trees[i].numbers() == per_node[i]);
    CHECK(c.trees[i].splits == (i == 2));
    CHECK(c.trees[i].volumes.size() == 3 * per_node[i]);
    CHECK(c.trees[i].replaces == (i == 0 ? std::uint32_t{kNull} : i - 1));
  }
  CHECK(c.trees[4].directions.at(3) == Eigen::Vector3d(1, 1, 1));
}

TEST_CASE("a stream has the same queries as the file, whatever its pieces, and needs their ends") {
  const Bytes bytes = record([] {
    for (int i = 0; i < 3; ++i) a_query();
  });
  const Capture whole = read(bytes);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{1000}, bytes.size()}) {
    CAPTURE(piece);
    Stream stream("pipe");
    CHECK(!stream.has_begun());
    const std::vector<Query> found = stream_queries(bytes, piece, stream);
    CHECK(stream.has_begun());
    CHECK(!stream.descriptions().cut_off);
    CHECK(stream.unfinished() == 0);
    CHECK(stream.descriptions().engine == whole.engine);
    CHECK(stream.descriptions().trees.size() == whole.trees.size());
    CHECK(stream.descriptions().names == whole.names);
    REQUIRE(found.size() == whole.queries.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK(found[i].number == whole.queries[i].number);
      CHECK(found[i].trees == whole.queries[i].trees);
      CHECK(found[i].events == whole.queries[i].events);
      CHECK(found[i].pairs == whole.queries[i].pairs);
      CHECK(found[i].complete());
    }
  }
  Stream stream("pipe");
  CHECK(stream_queries(
            Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(find_chunk(bytes, "QRYE"))), 100,
            stream)
            .empty());
  CHECK(stream.unfinished() == 1);
  CHECK(stream.descriptions().cut_off);
}

TEST_CASE("a capture cut off anywhere is read up to its last whole chunk") {
  const Bytes whole = record(a_query);
  const std::vector<std::size_t> chunks = chunks_of(whole);
  REQUIRE(chunks.back() == whole.size());
  const std::size_t begin = find_chunk(whole, "QRYB"), events = find_chunk(whole, "EVTS"),
                    end = find_chunk(whole, "QRYE"), stop = find_chunk(whole, "STOP");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CAPTURE(size);
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    if (size < kFileHeader) {
      contains(refusal(cut), {size == 0 ? "an empty file" : size < 8 ? "found" : "16 bytes"});
      continue;
    }
    const Capture c = read(cut);
    REQUIRE(c.cut_off);
    REQUIRE(c.queries.size() == (size >= events ? 1 : 0));
    if (size < events) continue;
    CHECK(c.queries[0].events.size() == (size >= end ? 6 : 0));
    CHECK(c.queries[0].ended == (size >= stop));
  }
  CHECK(begin < events);
}

TEST_CASE("other files are rejected with their apparent format") {
  const auto bytes = [](const std::string& s) {
    const auto* from = reinterpret_cast<const std::byte*>(s.data());
    return Bytes(from, from + s.size());
  };
  contains(refusal(bytes("v 0 0 0\nv 1 0 0\n")), {"found text: 'v 0 0 0'", "lrbscope_capture.h"});
  contains(refusal(bytes("{\"traceEvents\": []}")), {"found JSON"});
  contains(refusal(bytes("\x1f\x8b\x08")), {"gzip"});
  contains(refusal(bytes("\x7f"
                         "ELF\x01")),
           {"other bytes"});
  CHECK_FALSE(is_capture(bytes("LRBCAP")));
  const Bytes good = record(a_query);
  CHECK(is_capture(good));
  Bytes newer = good, swapped = good, marked = good;
  newer[8] = std::byte{2};
  contains(refusal(newer), {"expected version 1", "found 2"});
  for (int i = 0; i < 4; ++i) swapped[static_cast<std::size_t>(12 + i)] = std::byte(i + 1);
  contains(refusal(swapped), {"little-endian"});
  marked[12] = std::byte{9};
  contains(refusal(marked), {"byte order"});
  Bytes two = good;
  two.insert(two.end(), good.begin(), good.end());
  contains(refusal(two), {"a second capture begins here"});
}

TEST_CASE("unknown chunks are skipped, newer and damaged ones are refused") {
  const Bytes good = record(a_query);
  CHECK(read(with_chunk(good, "XTRA", 7, "what later versions add")).queries.at(0).complete());
  contains(refusal(with_chunk(good, "MESH", 2, "")), {"(MESH at byte ", "expected version 1, found 2"});
  contains(refusal(with_chunk(good, "ab\n\x01", 1, "")), {"chunk name", "damaged"});
  contains(refusal(with_chunk(good, "NAME", 1, "")), {"ends too early"});
  contains(refusal(with_chunk(good, "SYNC", 1, "123456789")), {"more content"});
  // Counts that the content does not have.
  struct Place {
    const char* kind;
    std::size_t offset;
  };
  for (const Place& p : {Place{"MESH", 4}, {"MESH", 8}, {"MESH", 12}, {"TREE", 12}, {"EVTS", 16}}) {
    CAPTURE(p.kind);
    CAPTURE(p.offset);
    contains(refusal(with(good, p.kind, p.offset, 0xfffffffeu)), {p.kind, "damaged"});
  }
}

TEST_CASE("descriptions of meshes and trees are checked") {
  const Bytes good = record(a_query);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  // MESH: id, vertices, triangles, length of the name, "wedge", coordinates, corners.
  contains(refusal(twice(good, "MESH")), {"chunk 5 (MESH at byte ", "new id of a mesh", "found 1"});
  contains(refusal(with(good, "MESH", 21 + 8 * 4, nan)), {"vertex 1: expected finite numbers"});
  contains(refusal(with(good, "MESH", 21 + 8 * 12 + 4 * 5, 4u)),
           {"triangle 1: expected a vertex below 4, found 4"});
  // TREE: 8 words, 4 offsets, 2 children, 4 offsets, 4 triangles, 18 doubles.
  contains(refusal(twice(good, "TREE")), {"new id of a tree"});
  contains(refusal(without(good, "MESH")), {"(TREE at byte ", "refers to mesh 1, which was not described"});
  contains(refusal(with(good, "TREE", 8, 9u)), {"refers to tree 9, which was not described"});
  contains(refusal(with(good, "TREE", 8, 1u)), {"tree 1 replaces itself"});
  contains(refusal(with(good, "TREE", 12, 0u)), {"at least one node"});
  contains(refusal(with(good, "TREE", 16, 6u)), {"bounding volume of kind 1", "found kind 6"});
  contains(refusal(with(good, "TREE", 24, 16u)), {"unknown options"});
  contains(refusal(with(good, "TREE", 24, 7u, 1)), {"AABBs, OBBs or k-DOPs of a tree with spatial splits"});
  contains(refusal(with(good, "TREE", 32, 1u)), {"offsets of child indices: expected 0 first, found 1"});
  contains(refusal(with(good, "TREE", 36, 3u)), {"offsets of child indices", "found 2 after 3 (node 1)"});
  contains(refusal(with(good, "TREE", 48, 3u)), {"node 0: expected a child below 3, found 3", "not ids"});
  contains(refusal(with(good, "TREE", 60, 5u)), {"offsets of triangle indices", "found 2 after 5 (node 1)"});
  contains(refusal(with(good, "TREE", 88 + 8 * 7, nan)), {"node 1: expected finite numbers of its volume"});
  contains(refusal(with(good, "TREE", 32, 10u, 1)), {"nodes 0 and 1 have the same id, 10"});
  // A k-DOP of more directions than its content holds, and of none.
  contains(refusal(with(with(good, "TREE", 16, 5u), "TREE", 20, 0xffffffffu)), {"more directions"});
  contains(refusal(with(with(good, "TREE", 16, 5u), "TREE", 20, 0u)), {"found kind 5"});
  contains(refusal(twice(good, "NAME")), {"new id of a name"});
  // Faults that the tree's report names are read: a child with two parents, a leaf's triangle that is none.
  CHECK(read(with(good, "TREE", 48, 2u)).trees[0].children(0)[0] == 2);
  CHECK(read(with(good, "TREE", 72, 77u)).trees[0].triangles(1)[0] == 77);
}

TEST_CASE("captures with invalid queries are rejected") {
  const Bytes good = record(a_query);
  // QRYB: 8 reserved, number, kind, trees, 8 reserved, thread, 4 reserved, poses.
  contains(refusal(twice(good, "QRYB")), {"(QRYB at byte ", "query 1: begins a second time"});
  contains(refusal(with(good, "QRYB", 8, 0u)), {"number of a query above 0"});
  contains(refusal(with(good, "QRYB", 12, 7u)), {"query 1: expected a query of kind 1", "found 7"});
  contains(refusal(with(good, "QRYB", 20, 5u)), {"query 1: refers to tree 5, which was not described"});
  // QRYE: ticks, number, verdict, pairs, events, 8 reserved.
  contains(refusal(without(good, "QRYB")), {"(EVTS at byte ", "query 1: the query was not begun"});
  contains(refusal(with(good, "QRYE", 8, 2u)), {"(QRYE at byte ", "query 2: the query was not begun"});
  contains(refusal(with(good, "QRYE", 12, 3u)), {"query 1: expected the verdict 0", "found 3"});
  contains(refusal(twice(good, "QRYE")), {"query 1: ends a second time"});
  contains(refusal(with(good, "QRYE", 24, std::uint64_t{5})), {"at least the 6 events stored, found 5"});
}

TEST_CASE("distances are read with their bounds, once, and of distance queries only") {
  const auto with_value = [](double lower, double upper, int times = 1, int kind = LRBCAP_DISTANCE) {
    return record([&] {
      const std::uint32_t tree = a_tree();
      LRBCAP_VALUE(1, 1);  // outside of a query: ignored
      LRBCAP_BEGIN(static_cast<std::uint32_t>(kind), tree, nullptr, tree, kPose);
      for (int i = 0; i < times; ++i) LRBCAP_VALUE(lower, upper);
      LRBCAP_END(LRBCAP_SEPARATE, 0);
    });
  };
  CHECK(read(with_value(0.5, 0.75)).queries.at(0).value == std::array<double, 2>{0.5, 0.75});
  CHECK_FALSE(read(with_value(0, 0, 0)).queries.at(0).value);
  contains(refusal(with_value(0.5, 0.25)),
           {"(VALU at byte ", "query 1: expected a finite lower bound", "0.5 and 0.25"});
  contains(refusal(with_value(0, std::numeric_limits<double>::infinity())), {"finite"});
  contains(refusal(with_value(std::numeric_limits<double>::quiet_NaN(), 1)), {"finite"});
  contains(refusal(with_value(0, 0, 2)), {"expected one value, before the end of its query"});
  contains(refusal(with_value(0, 0, 1, LRBCAP_ANY)), {"a value of a distance query only"});
}

TEST_CASE("rays, points and boxes are read with their frames, and refused if they are none") {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  using Numbers = std::array<double, 8>;
  const auto with_probe = [](std::uint32_t shape, const Numbers& n, std::uint32_t kind = LRBCAP_ALL_PAIRS,
                             std::uint32_t tree = 1, std::uint32_t b = 0) {
    return record([&] {
      a_tree();
      if (shape == 1) LRBCAP_RAY(kind, tree, kPose, n.data());
      if (shape == 2) LRBCAP_POINT(kind, tree, kPose, n.data());
      if (shape == 3) LRBCAP_BOX(kind, tree, kPose, n.data());
      LRBCAP_NODE(0, b, 1, LRBCAP_NO_AXIS);
      LRBCAP_END(LRBCAP_SEPARATE, 0);
    });
  };
  const Numbers ray{1, 2, 3, 0, 0, 4, 0.5, inf}, box{1, 2, 3, 4, 2, 6};
  const Query q = read(with_probe(1, ray, LRBCAP_DISTANCE)).queries.at(0);
  CHECK(q.probe.shape == ProbeShape::ray);
  CHECK(q.probe.numbers == ray);
  CHECK(q.trees == std::array<std::uint32_t, 2>{0, kNull});
  CHECK(q.poses[1].apply({2, 0, 0}) == Eigen::Vector3d(1, 2, 3 + 2));
  CHECK(read(with_probe(2, ray)).queries.at(0).poses[1].t == Eigen::Vector3d(1, 2, 3));
  CHECK(read(with_probe(3, box, LRBCAP_ANY)).queries.at(0).probe.numbers == box);
  for (const auto& [at, x] : {std::pair{std::size_t{0}, nan},
                              {0, 2e150},
                              {4, inf},
                              {5, 0.0},
                              {6, nan},
                              {6, inf},
                              {7, 0.25},
                              {7, nan}}) {
    Numbers wrong = ray;
    wrong[at] = x;
    contains(refusal(with_probe(1, wrong)),
             {"(QRYB at byte ", "expected finite numbers of at most 1e150, of a ray a direction"});
  }
  contains(refusal(with_probe(2, {1, nan, 3})), {"found 1 nan 3 0"});
  contains(refusal(with_probe(3, {1, 2, 3, 0, 2, 3})), {"of a box least and greatest"});
  contains(refusal(with_probe(1, ray, LRBCAP_SELF)), {"any or distance of one described tree with a ray"});
  contains(refusal(with_probe(1, ray, LRBCAP_ANY, 0)), {"one described tree"});
  contains(refusal(with_probe(1, ray, LRBCAP_ANY, 7)), {"refers to tree 7, which was not described"});
  contains(refusal(with_probe(1, ray, LRBCAP_ANY, 1, 2)),
           {"event 1: expected node and triangle 0 of the ray"});
  const Bytes good = with_probe(1, ray);
  contains(refusal(with(good, "QRYB", 20, 1u)), {"one described tree"});  // and another
  contains(refusal(with(good, "QRYB", 36, 4u)), {"expected a ray (1), a point (2) or a box (3), found 4"});
  // The version of the chunk keeps older readers from taking the numbers for a pose.
  constexpr std::size_t kVersion = 4 - kHeader;  // from the content backward
  contains(refusal(with(good, "QRYB", kVersion, 1u)), {"pose of B: expected a rotation"});
  contains(refusal(with(good, "QRYB", kVersion, 3u)), {"expected version 2, found 3"});
  Bytes cut = good;
  cut.resize(find_chunk(good, "QRYB") + 60);
  CHECK(read(cut).queries.empty());
}

TEST_CASE("a tree of instances is one with the moved trees and meshes of its bodies") {
  using Report = std::function<void()>;
  const auto in_query = [](const Report& events, bool enters = true) {
    return record([&] {
      const std::uint32_t body = a_tree(), row = a_row(body);
      LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, row, nullptr, body, kPose);
      LRBCAP_NODE(0, 0, 1, LRBCAP_NO_AXIS);
      if (enters) LRBCAP_ENTER(3, LRBCAP_TOP);
      events();
      LRBCAP_END(LRBCAP_SEPARATE, 0);
    });
  };
  const Bytes good = in_query([] {
    LRBCAP_NODE(2, 1, 1, LRBCAP_NO_AXIS);
    LRBCAP_PRIM(3, 1, 1);
    LRBCAP_ENTER(LRBCAP_TOP, LRBCAP_TOP);
    LRBCAP_NODE(1, 0, 0, LRBCAP_NO_AXIS);
  });
  const Capture c = read(good);
  REQUIRE(c.trees.size() == 2);
  const Tree& row = c.trees[1];
  CHECK(row.size() == 3 + 4 * 3);
  CHECK(row.volume == VolumeKind::obb);
  REQUIRE(row.children(2).size() == 2);
  CHECK(row.children(2)[1] == 12);
  CHECK(row.children(12)[1] == 14);
  CHECK(row.triangles(14)[1] == 15);
  CHECK(row.name_of_node(2) == "2");
  CHECK(row.name_of_node(14) == "2 of instance 3");
  CHECK(row.name_of_triangle(15) == "3 of instance 3");
  // The box of node 1, moved: centre and half axes.
  CHECK(std::vector(row.volume_of(13).begin(), row.volume_of(13).end()) ==
        std::vector<double>{7, 1, 0.5, 0, 1, 0, -1, 0, 0, 0, 0, 0.5});
  const Mesh& mesh = c.meshes.at(row.mesh);
  CHECK(mesh.name == "row");
  CHECK(mesh.vertices.at(13) == Eigen::Vector3d(8, 2, 0));
  CHECK(mesh.triangles.at(15) == std::array<std::uint32_t, 3>{12, 15, 14});
  const Query& q = c.queries.at(0);
  CHECK(q.complete());
  CHECK(q.events == std::vector<Event>{{0, 0, EventKind::nodes, 1, 1, 255},
                                       {14, 1, EventKind::nodes, 1, 1, 255},
                                       {15, 1, EventKind::triangles, 1, 1, 255},
                                       {1, 0, EventKind::nodes, 0, 1, 255}});

  contains(refusal(in_query([] { LRBCAP_ENTER(4, LRBCAP_TOP); })),
           {"event 3: expected an instance of A below 4, or LRBCAP_TOP, found 4"});
  contains(refusal(in_query([] { LRBCAP_ENTER(0, 0); })),
           {"an instance of B below 0, or LRBCAP_TOP, found 0"});
  contains(refusal(in_query([] { LRBCAP_NODE(3, 0, 1, 255); })),
           {"tree 1 (A), which has 3 nodes, found id 3"});
  contains(refusal(in_query([] { LRBCAP_NODE(3, 0, 1, 255); }, false)),
           {"tree 2 (A), which has 3 nodes, found id 3"});
  contains(refusal(in_query([] { LRBCAP_PRIM(0, 0, 1); }, false)),
           {"event 2: expected LRBCAP_ENTER before a test of triangles of A, a tree of instances"});
  contains(refusal(in_query([] { LRBCAP_PRIM(4, 0, 1); })), {"expected a triangle of A below 4, found 4"});
  // TREE: as above, then 4 numbers of trees and 4 poses.
  contains(refusal(with(good, "TREE", 72, 9u, 1)),
           {"node 1: expected an instance below 4, found 9", "from 0"});
  contains(refusal(with(good, "TREE", 232, 9u, 1)), {"refers to tree 9, which was not described"});
  contains(refusal(with(good, "TREE", 232, 2u, 1)),
           {"instance 0: expected the tree of a mesh, found tree 2"});
  contains(refusal(with(good, "TREE", 248 + 8, 0.5, 1)),
           {"instance 0: expected a rotation, a translation and a scale"});
  contains(refusal(with(good, "TREE", 248 + 24, HUGE_VAL, 1)), {"instance 0: expected a rotation"});
  contains(refusal(with(good, "TREE", 72, 77u)), {"instance 0: a leaf has triangle 77, its mesh has 4"});
  Bytes huge = good;  // a box of the body that a scale makes infinite
  for (const std::size_t axis : {0, 5, 10}) huge = with(huge, "TREE", 248 + 8 * axis, 1e10, 1);
  contains(refusal(with(huge, "TREE", 88 + 24, 1e300)), {"node 0 of tree 1: expected a volume", "finite"});
  contains(refusal(record([] { a_row(a_row(a_tree())); })),
           {"instance 0: expected the tree of a mesh, found tree 2"});
  contains(refusal(record([] { a_row(a_tree_with_ids()); })),
           {"AABBs and OBBs, or spheres and RSS, in the tree of instances"});
}

TEST_CASE("poses must be rigid, row by row") {
  const Bytes good = record(a_query);
  const auto with_pose = [&](std::array<double, 12> pose) { return with(good, "QRYB", 40 + 96, pose); };
  const double c = 0.6, s = 0.8;
  CHECK(read(with_pose({c, -s, 0, 1e300, s, c, 0, 0, 0, 0, 1, 0})).queries.size() == 1);
  CHECK(read(with_pose({1 + 4e-7, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0})).queries.size() == 1);
  contains(
      refusal(with_pose({1 + 1e-5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0})),
      {"query 1: pose of B: expected a rotation within 1e-6, found an error of 2e-05", "3x4 row by row"});
  contains(refusal(with_pose({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0})), {"determinant -1", "mirroring"});
  contains(refusal(with_pose({c, s, 0, -s, c, 0, 0, 0, 1, 7, 8, 9})),
           {"this one is rigid if read column by column"});
  contains(refusal(with_pose({2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0})), {"without scale"});
  const double inf = std::numeric_limits<double>::infinity();
  contains(refusal(with_pose({1, 0, 0, inf, 0, 1, 0, 0, 0, 0, 1, 0})), {"finite translation"});
  contains(refusal(with_pose({inf, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0})), {"expected a rotation"});
}

TEST_CASE("captures with invalid events are rejected") {
  const auto reported = [](const std::function<void()>& events, int kind = LRBCAP_ALL_PAIRS) {
    return record([&] {
      const std::uint32_t a = a_tree(), b = a_tree_with_ids();
      LRBCAP_BEGIN(static_cast<std::uint32_t>(kind), a, nullptr, b, kPose);
      events();
      LRBCAP_END(LRBCAP_SEPARATE, 0);
    });
  };
  const auto root = [] { LRBCAP_NODE(0, 30, 1, 255); };
  contains(refusal(reported([&] { root(), LRBCAP_NODE(3, 30, 1, 255); })),
           {"query 1, event 2: expected a node of tree 1 (A), which has 3 nodes, found id 3"});
  contains(refusal(reported([&] { root(), LRBCAP_NODE(1, 2, 1, 255); })),
           {"event 2", "tree 2 (B)", "found id 2"});
  contains(refusal(reported([&] { LRBCAP_PRIM(0, 4, 1); })),
           {"event 1: expected a triangle of B below 4, found 4"});
  // B has the ids 30, 10 and 20. Here each root has one child, which has the other.
  const auto without_root = [&](std::uint32_t a, std::uint32_t b) {
    const Bytes out = reported([&] { LRBCAP_PRIM(0, 1, 1), LRBCAP_NODE(a, b, 1, 255); });
    return with(with(out, "TREE", 36, 0x200000001u), "TREE", 48, 0x200000001u, 1);
  };
  CHECK(read(without_root(0, 10)).queries[0].complete());
  CHECK(read(without_root(1, 30)).queries[0].complete());
  contains(refusal(without_root(2, 30)),
           {"event 2: expected the roots or their children in the first test of nodes, found node 2 of A"});
  contains(refusal(without_root(0, 20)), {"found node 20 of B"});
  CHECK(read(reported([&] { LRBCAP_NODE(1, 10, 1, 255); }, LRBCAP_SELF)).queries[0].complete());
  contains(refusal(reported([&] { LRBCAP_NODES(0, 30, 2, 3, 255); })), {"event 1", "found 3 of 2"});
  contains(refusal(reported([&] { LRBCAP_NODES(0, 30, 0, 0, 255); })), {"event 1", "at least one test"});
  contains(refusal(reported([&] { LRBCAP_NODE(0, 30, 1, 15); })), {"event 1", "axis", "found 15"});
  CHECK(read(reported([&] { LRBCAP_NODE(0, 30, 0, 32 + 9); })).queries[0].events.at(0).axis == 41);
  contains(refusal(reported([&] { LRBCAP_COUNT(1, 5); })),
           {"event 1: refers to name 1, which was not described"});
  // The encoding. EVTS: query, thread, number of the first, count, chunk; events.
  const Bytes good = reported([&] { root(), LRBCAP_PRIM(3, 3, 1); });
  contains(refusal(with(good, "EVTS", 8, std::uint64_t{1})), {"expected event 0 of thread", "found event 1"});
  contains(refusal(with(good, "EVTS", 16, 1u)), {"more content"});
  contains(refusal(with(good, "EVTS", 24, std::uint8_t{0x80})), {"event 1: unknown bits"});
  contains(refusal(twice(good, "EVTS")), {"expected event 2 of thread"});
  const Bytes large = reported([&] { root(), LRBCAP_NODE(0x7fffffff, 30, 1, 255); });
  contains(refusal(with(large, "EVTS", 24 + 3 + 1 + 4, std::uint8_t{0x7f})), {"more than 32 bits"});
}

}  // namespace lrb::capture
