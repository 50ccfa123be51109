#include "tests/fuzz/seeds.hpp"

#include <algorithm>

#include "scenarios/bodies/shapes.hpp"
#include "tests/fuzz/feed.hpp"
#include "tests/mesh/io/encode.hpp"
#include "tests/support/lrb_files.hpp"
#include "tests/support/lrb_shapes.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::fuzz {
namespace {

std::vector<std::string> meshes() {
  const Mesh body = shapes::tetrahedron(), box = shapes::quad_box();
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1 1\n";
  std::vector<std::string> out;
  for (const Mesh& m : {body, box})
    for (const std::string& file :
         {test::to_ply_ascii(m), test::to_ply_binary(m, false), test::to_ply_binary(m, true, false)})
      out.push_back('\2' + file);
  out.push_back('\1' + test::to_stl_ascii(body));
  out.push_back('\1' + test::to_stl_binary(body));
  for (const Mesh& m : {body, box}) out.push_back('\3' + test::to_off(m));
  out.push_back(
      '\3' +
      std::string("COFF # colours\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2 255 0 0\n"));
  out.push_back(
      '\0' + points +
      "# note\nvn 0 0 1\nvt 0 0\ng x\nusemtl y\nf 1 3 2\nf 1/1 2/1 4/1\nf 2//1 3//1 4//1\nf -4/1/1 -1 -2\n");
  out.push_back('\0' + std::string("v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 \\\n3 1\n"));
  // A concave polygon, one with a bridge to a hole, and one that touches and crosses itself.
  out.push_back('\0' + std::string("v 0 0 0\nv 6 0 0\nv 6 6 1\nv 0 6 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\n"
                                   "f 1 2 3 4 5\nf 1 2 3 4 1 5 6 7 5\nf 1 2 7 5 3 2 6 4\n"));
  return out;
}

/// Small bodies, as a tree of one block is 512 bytes; one has a tree with a root. Version 1 has no tree.
std::vector<std::string> lrb_files() {
  const LrbRep plate(toy::small_plate()), pit(toy::dented_tetrahedron()), two_blocks(toy::notched_plate()),
      flat(LrbRep::without_regions(shapes::tetrahedron(), true, false));
  std::vector<std::string> files;
  for (const LrbRep& rep : {plate, pit, two_blocks, flat}) files.push_back(test::lrb_bytes(rep));
  plate.levels();
  files.push_back(test::lrb_bytes(plate));
  for (const LrbRep& rep : {plate, pit, LrbRep(toy::dented_box())})
    files.push_back(test::lrb_bytes_version_1(rep));
  for (std::string& file : files) file.insert(0, 1, '\1');  // see feed.hpp
  return files;
}

/// No edit at all of each file of feed_fields.cpp, and some edits.
std::vector<std::string> field_edits() {
  std::vector<std::string> out;
  for (char file = 0; file < 12; ++file) out.push_back({file});
  return out;
}

/// Bodies of each family, as they are and with their polygons folded.
std::vector<std::string> folded_bodies() {
  std::vector<std::string> out = {
      "0v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"};
  for (char family = 0; family < 4; ++family) {
    out.push_back({'1', family, 5, 0, 3});
    out.push_back({'2', family, 5, 40, 3});
    for (int i = 0; i < 40; ++i) out.back() += static_cast<char>(37 * i * i + family);
  }
  return out;
}

std::vector<std::string> poses() {
  return {"1 0 0 3 0 1 0 0 0 0 1 0\n",
          "# note\r\n1,0,0,+3,0,1,0,-0,0,0,1,1e-300\n\n.5 0 0 1e3 0 1 0 0 0 0 1 0 # end",
          "n,r00,r01,r02,tx,r10,r11,r12,ty,r20,r21,r22,tz\n\"a,b\",1,0,0,3,0,1,0,0,0,0,1,0\n",
          "1,0,0,3,0,1,0,0,0,0,1,0,0,0,0,1\n",
          "{\"poses\": [[1,0,0,3,0,1,0,0,0,0,1,0], [[1,0,0,3],[0,1,0,0],[0,0,1,0],[0,0,0,1]]]}\n"};
}

const char* const kBodies =
    R"("bodies": {"a": {"generator": "ball", "parameters": {"frequency": 3}, "pose": {"position": [1, 2, 3], "axis": [0, 0, 1], "degrees": 30}},
 "b": {"file": "b.obj", "build": {"patch_interior": 5, "max_outer_faces": 20, "seed": 3}, "pose": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]}})";

std::vector<std::string> shipped(const std::string& ending) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(LRB_SOURCE_DIR "/scenarios/shipped"))
    if (entry.path().string().ends_with(ending)) out.push_back(test::load_bytes(entry.path().string()));
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::string> scenarios() {
  std::vector<std::string> out = shipped(".scenario.json");
  const std::string begin =
      std::string(R"({"name": "x", "purpose": "y", "seed": 7, )") + kBodies + R"(, "motion": )";
  out.push_back(
      begin +
      R"({"kind": "poses", "poses": [{"position": [0, 0, 1]}, [1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0]]}, "query": {"mode": "all", "recursion": "paper", "predicates": "floating", "wrapper": "unregularised", "contacts": true, "interiors_overlap": true}, "trace": {"clock": "wall", "max_events": 1000, "gzip": true}, "expect": [{"step": 0, "relation": "separate", "pairs": 0, "fingerprint": "cbf29ce484222325"}]})");
  out.push_back(
      begin +
      R"({"kind": "keyframes", "keyframes": [{"step": 0, "position": [0, 0, 1]}, {"step": 4, "position": [0, 1, 1], "axis": [1, 1, 0], "degrees": 45}]}, "frames": {"at": "event", "every": 2, "most": 5, "size": [320, 200], "supersampling": 1, "colour_by": "layer", "transparent": true, "explode": 0.5, "montage": {"panels": 4, "columns": 2}, "views": [{"camera": "fixed", "eye": [1, 2, 3], "target": [0, 0, 0], "projection": "orthographic"}, {"camera": "orbit", "from": [1, 0, 0], "up": [0, 0, 1], "turn_degrees": 90, "zoom": 2, "draw": "body", "title": "t"}]}})");
  out.push_back(
      begin +
      R"({"kind": "sweep", "from": [0, 0, 0], "to": [1, 1, 1], "axis": [0, 1, 0], "degrees": 90, "steps": 5}, "frames": {"events": [1, 5]}})");
  out.push_back(
      begin +
      R"({"kind": "sweep", "from": [0, 0, 0], "to": [1, 1, 1]}, "query": {"tolerance": 0.25, "max_tests": 200, "separation": true}, "expect": [{"step": 0, "relation": "unresolved"}]})");
  out.push_back(begin + R"({"kind": "spin", "axis": [0, 1, 0], "degrees": 90, "steps": 5}})");
  return out;
}

std::vector<std::string> traces() {
  std::vector<std::string> out;
  const LrbRep box(toy::dented_box()), plate(toy::notched_plate());
  for (const trace::Clock clock : {trace::Clock::event, trace::Clock::wall}) {
    trace::RecorderSettings settings;
    settings.clock = clock;
    settings.event_cap = 8;  // seeds are best small
    out.push_back(trace::trace_to_json(trace::runs::record(box, box, {{1.7, 1.8, 2.5}}, settings).trace));
  }
  trace::Recorder recorder(plate, {});
  recorder.begin_step(0, Pose{});
  recorder.refine(Side::a, 2, 4);
  recorder.coarsen(Side::a, 2, 4);
  out.push_back(trace::trace_to_json(recorder.take()));
  trace::RecorderSettings coarse;
  coarse.request.tolerance = 0.5;
  coarse.request.max_tests = 9;
  coarse.request.separation = true;
  trace::Recorder other(plate, plate, coarse);
  other.begin_step(0, Pose{});
  const SimplexId pseudo(plate.real_simplex_count());
  other.face_test(1, pseudo, exact::Meet::touch, 0, 0);
  other.contact(1, pseudo, exact::Meet::touch);
  CollideResult result;
  result.relation = Relation::unresolved;
  result.error_bound = 0.25;
  result.finished = false;
  result.separation = Separation{{{{0}, {1}}}, {7, 6}};
  other.end_step(result);
  out.push_back(trace::trace_to_json(other.take()));
  return out;
}

/// Bytes that choose each query, for each kind of body; mutations do the rest.
std::vector<std::string> motions() {
  std::vector<std::string> out;
  for (const int query : {0, 2, 3, 64, 66, 128})
    for (const int a : {0, 3, 4, 8})
      for (const int b : {1, 2, 5}) {
        std::string bytes = {static_cast<char>(query), static_cast<char>(a), static_cast<char>(b)};
        for (int i = 0; i < 48; ++i)
          bytes.push_back(static_cast<char>(i % 2 == 0 ? 5 : 124 + (i * 7 + a + b) % 11));
        out.push_back(bytes);
      }
  return out;
}

}  // namespace

std::vector<Format> formats() {
  return {{"mesh", feed_mesh, meshes()},
          {"lrb", feed_lrb, lrb_files()},
          {"fields", feed_fields, field_edits()},
          {"body", feed_body, folded_bodies()},
          {"poses", feed_poses, poses()},
          {"scenario", feed_scenario, scenarios()},
          {"crowd", feed_crowd, shipped(".crowd.json")},
          {"experiment", feed_experiment, shipped(".experiment.json")},
          {"trace", feed_trace, traces()},
          {"capture", feed_capture, captures()},
          {"motion", feed_motion, motions()}};
}

}  // namespace lrb::fuzz
