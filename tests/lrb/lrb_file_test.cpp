// What comes back from a .lrb file is what went in, and nothing else is taken for one.
#include <algorithm>
#include <cstring>
#include <limits>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/mesh/io/encode.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/lrb_files.hpp"
#include "tests/support/lrb_shapes.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

using namespace lrb;
using shapes::RandomEngine;
using test::with_right_checksum;

namespace {

constexpr auto& bytes_of = test::lrb_bytes;

/// Returns the error for bytes, or an empty string if they are accepted.
std::string complaint(const std::string& bytes) {
  return test::error_of([&] { load_lrb(std::string_view(bytes), "body.lrb"); });
}

bool is_one_line(const std::string& text) {
  return std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; });
}

template <class T>
std::string with(std::string bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  return with_right_checksum(bytes);
}

constexpr std::size_t kVersionAt = test::kVersionAt, kDimAt = 12, kNameAt = test::kNameAt;

}  // namespace

TEST_CASE("a saved LRB-rep is loaded unchanged, with its tree") {
  for (const LrbRep& rep : {shapes::dented_box(), shapes::stairs_2d(), build_lrb(shapes::torus(40, 30)),
                            build_lrb(shapes::scaled(shapes::bumpy_sphere(3, 1), 1e-200)),
                            LrbRep::without_regions(shapes::open_cylinder(8), false, true)}) {
    const LrbRep back = load_lrb(std::string_view(bytes_of(rep)), "body.lrb");
    CHECK(back.hash() == rep.hash());
    CHECK(back.closed() == rep.closed());
    CHECK(back.tree().bounds_hold(back.simplices()));
    CHECK(back.tree().height() == rep.tree().height());
    CHECK(bytes_of(back) == bytes_of(rep));
  }
}

TEST_CASE("every truncated file is rejected in one line") {
  const std::string whole = bytes_of(shapes::dented_box());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string text = complaint(whole.substr(0, size));
    REQUIRE_FALSE(text.empty());
    REQUIRE(is_one_line(text));
    // A truncation with a plausible end must be detected by the reader, not by the checksum.
    if (size > 20) REQUIRE_FALSE(complaint(with_right_checksum(whole.substr(0, size))).empty());
  }
  REQUIRE_FALSE(complaint(whole + '\0').empty());
  REQUIRE_FALSE(complaint(with_right_checksum(whole + std::string(8, '\0'))).empty());
}

TEST_CASE("every changed byte is detected") {
  const std::string whole = bytes_of(shapes::stairs_2d());
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const int change : {1, 0x80, 0xff}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      REQUIRE_FALSE(complaint(damaged).empty());
    }
}

TEST_CASE("a file is read in chunks as it is from memory") {
  const test::Folder folder;
  const std::string path = folder / "body.lrb";
  // Arrays and their elements continue from chunk to chunk (256 KiB). The names shift them.
  for (const std::size_t length : {1, 7, 500, 300'000}) {
    LrbData d = build_lrb(shapes::bumpy_sphere(5, 3)).data();
    d.name = std::string(length, 'n');
    const LrbRep rep(std::move(d));
    if (length == 7) rep.levels();
    save_lrb(rep, path);
    const std::string whole = test::load_bytes(path);
    REQUIRE(whole.size() > 1'000'000);
    REQUIRE(bytes_of(load_lrb(path)) == whole);
    const auto complaint_of = [&](const std::string& bytes) {
      write_file(path, bytes);
      return test::error_of([&] { load_lrb(path); });
    };
    RandomEngine random(length);
    for (int i = 0; i < 20; ++i) {
      std::string damaged = whole;
      damaged[16 + random() % (whole.size() - 16)] ^= 1;
      REQUIRE(complaint_of(damaged).find("the checksum does not match") != std::string::npos);
      const std::size_t size = random() % whole.size();
      REQUIRE(complaint_of(whole.substr(0, size)) != "");
    }
    // A fault behind a right checksum has the same message from a file and from memory.
    for (const std::string& bad : {with_right_checksum(whole.substr(0, whole.size() - 100)),
                                   with_right_checksum(whole + std::string(300'000, '\0')),
                                   with(whole, kNameAt + 8 + length, ~std::uint64_t{0})}) {
      const std::string expected = complaint(bad);
      REQUIRE(expected.find("body.lrb") == 0);
      CHECK(complaint_of(bad) == path + expected.substr(8));
    }
  }
}

TEST_CASE("a name with control characters does not break a message into lines") {
  LrbData d = shapes::stairs_2d().data();
  d.name = "two\nlines\x1b[31m";
  const std::string whole = bytes_of(LrbRep(d));
  CHECK(load_lrb(std::string_view(whole), "body.lrb").name() == d.name);
  const std::string text = complaint(with(whole, kDimAt, std::uint32_t{7}));
  CHECK_FALSE(text.empty());
  CHECK(is_one_line(text));
}

TEST_CASE("a 2D body has two coordinates") {
  LrbData d = shapes::stairs_2d().data();
  d.vertices[0].z() = 1;
  CHECK_THROWS_AS(LrbRep{d}, InputError);
}

namespace {

/// A body's tree with something changed.
template <class Change>
std::pair<std::vector<TreeNode>, std::vector<LeafBlock>> changed(const LrbRep& rep, Change change) {
  std::pair<std::vector<TreeNode>, std::vector<LeafBlock>> tree{rep.tree().nodes(), rep.tree().blocks()};
  change(tree.first, tree.second);
  return tree;
}

}  // namespace

TEST_CASE("files of version 2 are read, without levels of detail") {
  const LrbRep rep = build_lrb(shapes::bumpy_sphere(2, 1));
  std::string old = bytes_of(rep);
  old.erase(old.size() - 8 - sizeof(std::uint32_t), sizeof(std::uint32_t));
  const std::uint32_t version = 2;
  std::memcpy(old.data() + kVersionAt, &version, sizeof version);
  const LrbRep back = load_lrb(std::string_view(with_right_checksum(old)), "body.lrb");
  CHECK(!back.has_levels());
  CHECK(bytes_of(back) == bytes_of(rep));
}

TEST_CASE("stored levels of another body: incomplete wrappers are rejected, wrong deviations are found") {
  const LrbRep rep = build_lrb(shapes::bumpy_sphere(3, 1));
  using Needed = std::vector<double>;
  using Levels = std::vector<WrapperLevels::StoredLevel>;
  const auto make = [&](auto change) {
    Needed needed(rep.levels().needed().begin(), rep.levels().needed().end());
    Levels levels;
    for (const WrapperLevel& level : rep.levels().all())
      levels.push_back({level.bound, level.tree.nodes(), level.tree.blocks()});
    change(needed, levels);
    LrbRep changed(rep.data());
    changed.keep_levels(WrapperLevels(changed, needed, std::move(levels)));
    return changed;
  };
  CHECK_THROWS_AS(make([](Needed& n, Levels&) { n.pop_back(); }), InputError);
  CHECK_THROWS_AS(make([](Needed& n, Levels&) { n[0] = -1; }), InputError);
  CHECK_THROWS_AS(make([](Needed& n, Levels&) { n[0] = std::numeric_limits<double>::quiet_NaN(); }),
                  InputError);
  CHECK_THROWS_AS(make([](Needed&, Levels& l) { l[0].bound = std::numeric_limits<double>::infinity(); }),
                  InputError);
  CHECK_THROWS_AS(make([](Needed&, Levels& l) { l[1].bound = l[0].bound; }), InputError);
  CHECK_THROWS_AS(make([](Needed&, Levels& l) { std::swap(l[0].nodes, l[1].nodes); }), InputError);
  CHECK_THROWS_AS(make([](Needed&, Levels& l) { l[2].blocks[0].simplex[0] = 0xfffffff; }), InputError);
  CHECK_THROWS_AS(make([](Needed&, Levels& l) { l[2].nodes[0].first = 0; }), InputError);
  CHECK_THROWS_AS(make([](Needed&, Levels& l) { l.resize(1000); }), InputError);
  // A region that is included without what it hides: the wrapper would leave some of the body out.
  RegionId over = kNull;
  for (RegionId r = 0; r < rep.region_count(); ++r)
    for (const FaceId lid : rep.lids(r))
      if (is_region(rep.outer_cell(lid)) && rep.levels().needed()[r] > 0)
        over = rep.outer_cell(lid).as_region();
  REQUIRE(over != kNull);
  CHECK_THROWS_AS(make([&](Needed& n, Levels&) { n[over] = 0; }), InputError);
  const auto found = [&](auto change) { return !validate(make(change)).valid; };
  CHECK(found([](Needed&, Levels& l) { l[1].nodes[0].hi[1][0] = l[1].nodes[0].lo[1][0]; }));
  // All regions half as thick as they are, and the levels, too: wrappers that enclose the body, and bounds
  // that are not proved.
  CHECK(found([](Needed& n, Levels& l) {
    for (double& x : n) x /= 2;
    for (auto& level : l) level.bound /= 2;
  }));
  CHECK_FALSE(found([](Needed&, Levels&) {}));
}

TEST_CASE("files of version 1 are read, and written in the current version") {
  const LrbRep rep = build_lrb(shapes::bumpy_sphere(2, 1));
  const LrbRep back = load_lrb(std::string_view(test::lrb_bytes_version_1(rep)), "body.lrb");
  CHECK(back.hash() == rep.hash());
  CHECK(bytes_of(back) == bytes_of(rep));
  std::string damaged = test::lrb_bytes_version_1(rep);
  damaged[60] ^= 1;
  CHECK(complaint(damaged).find("checksum") != std::string::npos);
}

TEST_CASE("a stored tree of another body: unsafe ones are rejected, wrong bounds are found") {
  const LrbRep rep = build_lrb(shapes::torus(40, 30));
  using Nodes = std::vector<TreeNode>;
  using Blocks = std::vector<LeafBlock>;
  const auto make = [&](auto change) {
    auto [nodes, blocks] = changed(rep, change);
    return LrbRep(rep.data(), nodes, blocks, rep.hash());
  };
  CHECK_THROWS_AS(make([](Nodes& n, Blocks&) { n[0].first = 0; }), InputError);
  CHECK_THROWS_AS(make([](Nodes& n, Blocks&) { n[0].first = ~0u; }), InputError);
  CHECK_THROWS_AS(make([](Nodes& n, Blocks&) { n[0].count = 9; }), InputError);
  CHECK_THROWS_AS(make([](Nodes& n, Blocks&) { n[0].count = 0; }), InputError);
  CHECK_THROWS_AS(make([](Nodes& n, Blocks&) { --n[0].count; }), InputError);
  CHECK_THROWS_AS(make([](Nodes& n, Blocks&) { n.back().first = ~0u; }), InputError);
  CHECK_THROWS_AS(make([](Nodes& n, Blocks&) { n.back().is_leaf = 7; }), InputError);
  CHECK_THROWS_AS(make([](Nodes& n, Blocks&) { n.clear(); }), InputError);
  CHECK_THROWS_AS(make([](Nodes& n, Blocks&) { n.push_back(n.back()); }), InputError);
  CHECK_THROWS_AS(make([](Nodes&, Blocks& b) { b[0].simplex[0] = kNull; }), InputError);
  CHECK_THROWS_AS(make([](Nodes&, Blocks& b) { b[0].simplex[0] = b[1].simplex[0]; }), InputError);
  CHECK_THROWS_AS(make([](Nodes&, Blocks& b) { b.pop_back(); }), InputError);
  const auto found = [&](auto change) {
    const LrbRep wrong = make(change);
    return !wrong.tree().bounds_hold(wrong.simplices()) && !validate(wrong).valid;
  };
  CHECK(found([](Nodes& n, Blocks&) { n[0].hi[1][0] = n[0].lo[1][0]; }));
  CHECK(found([](Nodes& n, Blocks&) { n.back().origin[2] += 1; }));
  CHECK(found([](Nodes& n, Blocks&) { n[1].radius /= 4; }));
  CHECK(found([](Nodes& n, Blocks&) { n[2].frame[0][0] *= 2; }));
  CHECK(found([](Nodes&, Blocks& b) { b[3].corner[1][0][2] += 0.01f; }));
  CHECK(found([](Nodes& n, Blocks&) { n[0].base[0] = std::numeric_limits<float>::quiet_NaN(); }));
  CHECK_FALSE(found([](Nodes&, Blocks&) {}));
  const LrbRep misnamed(rep.data(), rep.tree().nodes(), rep.tree().blocks(), rep.hash() + 1);
  CHECK_FALSE(validate(misnamed).valid);
}
