#include "engine/scene/build_cache.hpp"

#include <filesystem>

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path());
  return out;
}

/// A body made with a cache, and whether that built it.
struct Made {
  Body body;
  bool built;
};

Made made(Mesh mesh, const fs::path& cache, BuildOptions build = {}) {
  bool built = false;
  BodyOptions options;
  options.build = build;
  options.build.cache = cache.string();
  options.build.progress = [&](std::uint32_t, std::uint32_t) { built = true; };
  Body body = Body::from(std::move(mesh), options).value();
  return {std::move(body), built};
}

Mesh named(Mesh mesh, const char* name) {
  mesh.name = name;
  return mesh;
}

bool mentions(const Body& body, const std::string& what) {
  return std::any_of(body.notes().begin(), body.notes().end(),
                     [&](const std::string& note) { return note.find(what) != std::string::npos; });
}

/// Two balls that cross: no levels of detail.
Mesh crossing_balls() {
  return shapes::several({shapes::icosphere(2), shapes::icosphere(2, 1, {0.9, 0.1, 0.05})});
}

}  // namespace

TEST_CASE("cache: every kind of body gives the same answers with and without it") {
  struct Kind {
    const char* name;
    Mesh mesh;
    bool kept;  ///< has an LRB-rep
  };
  const std::vector<Kind> kinds = {
      {"rock", shapes::bumpy_sphere(3, 7, 0.3), true},
      {"open", shapes::open_cylinder(12), false},
      {"crossing", crossing_balls(), true},
      {"two components", shapes::several({shapes::icosphere(2), shapes::icosphere(2, 1, {3, 0, 0})}), true},
      {"void", shapes::box_with_void(), true},
      {"polygons", shapes::quad_torus(12, 8), true},
      {"inside out", shapes::turned_inside_out(shapes::torus(16, 10)), true},
      {"2D", shapes::gear(40), true}};
  for (const Kind& kind : kinds) {
    CAPTURE(kind.name);
    const Folder folder;
    const Mesh mesh = named(kind.mesh, kind.name);
    const Body plain = Body::from(mesh).value();
    const Body first = made(mesh, folder.path).body;
    CHECK(files_of(folder.path).size() == (kind.kept ? 1 : 0));
    const Made second = made(mesh, folder.path);
    CHECK_FALSE(second.built);
    for (const Body& body : {first, second.body}) {
      CHECK(body.rep().hash() == plain.rep().hash());
      CHECK(body.name() == plain.name());
      CHECK(body.turned() == plain.turned());
      CHECK(std::equal(body.notes().begin(), body.notes().end(), plain.notes().begin(), plain.notes().end()));
    }
    // Exact and coarse queries.
    const Pose pose{Eigen::Matrix3d::Identity(), {0.5, 0.3, 0}};
    for (const double tolerance : {0.0, 0.05}) {
      if (tolerance > 0 && !plain.rep().closed()) continue;
      CollideRequest request;
      request.tolerance = tolerance;
      const CollideResult expected = collide(plain, {}, plain, pose, request);
      const CollideResult found = collide(second.body, {}, second.body, pose, request);
      CHECK(found.pairs == expected.pairs);
      CHECK(found.relation == expected.relation);
      CHECK(found.error_bound == expected.error_bound);
    }
  }
}

TEST_CASE("cache: an entry belongs to the coordinates, the settings and the versions, not to the name") {
  const Folder folder;
  const Mesh mesh = named(shapes::bumpy_sphere(2, 1), "first");
  CHECK(made(mesh, folder.path).built);
  const Made again = made(named(mesh, "second"), folder.path);
  CHECK_FALSE(again.built);
  CHECK(again.body.name() == "second");
  CHECK(again.body.rep().has_levels());
  Mesh moved = mesh;
  moved.vertices[5].x() = std::nextafter(moved.vertices[5].x(), 2);
  CHECK(made(moved, folder.path).built);
  BuildOptions options;
  for (const auto& change : std::initializer_list<void (*)(BuildOptions&)>{
           [](BuildOptions& o) { o.lean = true; }, [](BuildOptions& o) { o.seed = 2; },
           [](BuildOptions& o) { o.patch_interior = 8; }, [](BuildOptions& o) { o.max_outer_faces = 30; },
           [](BuildOptions& o) { o.max_lids = 12; }, [](BuildOptions& o) { o.merge_planes = true; }}) {
    BuildOptions other;
    change(other);
    CHECK(cache_entry(mesh, other) != cache_entry(mesh, options));
    CHECK(made(mesh, folder.path, other).built);
  }
  options.threads = 2;
  CHECK_FALSE(made(mesh, folder.path, options).built);
  // The entry of another version has another name.
  const std::string entry = cache_entry(mesh, {});
  const std::string versions =
      "." + std::to_string(kBuilderVersion) + "." + std::to_string(kLrbFileVersion) + "-";
  REQUIRE(entry.find(versions) != std::string::npos);
  std::string older = entry;
  older.replace(older.find(versions), versions.size(), ".0.1-");
  fs::rename(folder.path / entry, folder.path / older);
  CHECK(made(mesh, folder.path).built);
}

TEST_CASE("cache: damaged and foreign entries are built again, with a note") {
  const Folder folder;
  const Mesh mesh = named(shapes::bumpy_sphere(2, 1), "rock");
  const std::uint64_t expected = made(mesh, folder.path).body.rep().hash();
  const fs::path entry = folder.path / cache_entry(mesh, {});
  const std::string sound = read_file(entry.string());
  std::string flipped = sound;
  flipped[flipped.size() / 2] ^= 1;
  std::string newer = sound;
  newer[8] = 99;  // the version, or part of the magic: not loaded either way
  // The LRB-rep of another mesh under this name.
  const Mesh other = named(shapes::bumpy_sphere(2, 2), "other");
  made(other, folder.path);
  const std::string foreign = read_file((folder.path / cache_entry(other, {})).string());
  for (const std::string& bad : {std::string(), sound.substr(0, sound.size() / 2), flipped, newer, foreign}) {
    write_file(entry.string(), bad);
    const Made again = made(mesh, folder.path);
    CHECK(again.built);
    CHECK(again.body.rep().hash() == expected);
    CHECK(mentions(again.body, "rock: built again, because its cached LRB-rep cannot be used: "));
    CHECK(read_file(entry.string()) == sound);
    const Made after = made(mesh, folder.path);
    CHECK_FALSE(after.built);
    CHECK(after.body.notes().empty());
  }
}

TEST_CASE("cache: without a usable folder the body is built, with one note") {
  const Folder folder;
  folder.write("file", "");
  const Mesh mesh = named(shapes::bumpy_sphere(2, 1), "rock");
  // A folder that is a file, one below a file, and one that permits no files, which root ignores.
  std::vector<fs::path> unusable = {folder / "file", folder.path / "file" / "below"};
  const fs::path closed = folder.path / "closed";
  fs::create_directory(closed);
  fs::permissions(closed, fs::perms::owner_read | fs::perms::owner_exec);
  if (geteuid() != 0) unusable.push_back(closed);
  for (const fs::path& cache : unusable) {
    const Made m = made(mesh, cache);
    CHECK(m.built);
    CHECK(m.body.rep().hash() == Body::from(mesh).value().rep().hash());
    REQUIRE(m.body.notes().size() == 1);
    CHECK(m.body.notes()[0].starts_with(cache.string()));
    CHECK(m.body.notes()[0].ends_with("; continuing without the cache of LRB-reps"));
    CHECK(m.body.notes()[0].find('\n') == std::string::npos);
  }
  // /proc has no files that could be created, for root either.
  const Made m = made(mesh, "/proc");
  CHECK(m.built);
  REQUIRE(m.body.notes().size() == 1);
  CHECK(m.body.notes()[0].starts_with("/proc: "));
  fs::permissions(closed, fs::perms::owner_all);
}

TEST_CASE("cache: several processes share a folder") {
  const Folder folder;
  const Mesh mesh = named(shapes::bumpy_sphere(3, 1), "rock");
  const std::uint64_t expected = Body::from(mesh).value().rep().hash();
  constexpr int kProcesses = 4, kRepeats = 5;
  std::vector<pid_t> children;
  for (int p = 0; p < kProcesses; ++p) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      // Deletes the entry between builds, as a user may at any time.
      bool good = true;
      for (int i = 0; i < kRepeats; ++i) {
        const Made m = made(mesh, folder.path);
        good = good && m.body.rep().hash() == expected && m.body.notes().empty();
        if (p == 0) fs::remove(folder.path / cache_entry(mesh, {}));
      }
      _exit(good ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    CHECK(status == 0);
  }
  made(mesh, folder.path);
  // No temporary files.
  const std::vector<fs::path> files = files_of(folder.path);
  REQUIRE(files.size() == 1);
  CHECK(files[0].filename() == cache_entry(mesh, {}));
  CHECK_FALSE(made(mesh, folder.path).built);
}

TEST_CASE("cache: a probe observes a build, not an entry") {
  struct Count : ConstructProbe {
    int passes = 0;
    void pass(const PassStart&) override { ++passes; }
  } probe;
  const Folder folder;
  const Mesh mesh = shapes::bumpy_sphere(2, 1);
  made(mesh, folder.path);
  BuildOptions options;
  options.probe = &probe;
  CHECK(made(mesh, folder.path, options).built);
  CHECK(probe.passes > 0);
}

}  // namespace lrb::test
