/// matrix_bodies DIR [NOISY]: writes the bodies of the matrix with their properties, for doors.py:
/// DIR/matrix.json, and of each kind NAME.obj, a file of another format and its corners; for each cell poses,
/// a motion and a scenario. matrix_bodies --save MESH FILE.lrb: saves a body without levels, as a program in
/// C++ may; which `lrbscope build` does not.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "tests/matrix/bodies.hpp"
#include "tests/mesh/io/encode.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>

using namespace lrb;
using namespace lrb::matrix;
using Json = nlohmann::ordered_json;

namespace {

std::vector<double> numbers_of(const Pose& pose) {
  std::vector<double> out;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.push_back(pose.r(i, j));
    out.push_back(pose.t[i]);
  }
  return out;
}

std::string text_of(const Pose& pose) {
  std::string out;
  for (const double x : numbers_of(pose)) out += test::digits(x) + " ";
  return out;
}

Json steps_of(const Cell& cell) {
  Json out = Json::array();
  for (const Step& s : cell.steps) {
    Json pairs = Json::array();
    for (const SimplexPair& p : s.truth.pairs) pairs.push_back({p.a.value(), p.b.value()});
    char fingerprint_text[17];
    std::snprintf(fingerprint_text, sizeof fingerprint_text, "%016llx",
                  static_cast<unsigned long long>(fingerprint(s.truth.pairs)));
    out.push_back({{"pose", numbers_of(s.pose)},
                   {"relation", to_string(s.truth.relation)},
                   {"pairs", pairs},
                   {"fingerprint", fingerprint_text},
                   {"distance", s.distance}});
  }
  return out;
}

/// The cell as a scenario, which states its own answers.
Json scenario_of(const Matrix& m, const Cell& cell, const std::string& name) {
  Json poses = Json::array(), expect = Json::array();
  const Json steps = steps_of(cell);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    poses.push_back(steps[i]["pose"]);
    expect.push_back({{"step", i},
                      {"relation", steps[i]["relation"]},
                      {"pairs", steps[i]["pairs"].size()},
                      {"fingerprint", steps[i]["fingerprint"]}});
  }
  return {
      {"name", name},
      {"purpose", "A cell of the matrix."},
      {"bodies",
       {{"a", {{"file", m.kinds[cell.a].name + ".obj"}}}, {"b", {{"file", m.kinds[cell.b].name + ".obj"}}}}},
      {"motion", {{"kind", "poses"}, {"poses", poses}}},
      {"query",
       {{"contacts", true},
        {"distance", true},
        {"clash", m.kinds[cell.a].mesh.dim == 3},
        {"near", 0},
        {"manifold", cell.size / 20},
        {"points", m.kinds[cell.b].name + ".points.txt"}}},
      {"frames", {{"at", "step"}, {"size", {640, 480}}, {"supersampling", 1}}},
      {"expect", expect}};
}

void write_matrix(const std::filesystem::path& folder, int noisy) {
  std::filesystem::create_directories(folder);
  const auto save = [&](const std::string& name, const std::string& bytes) {
    test::save(folder / name, bytes);
  };
  const Matrix m = make_matrix(noisy);
  Json kinds = Json::array(), cells = Json::array();
  for (const Kind& k : m.kinds) {
    save(k.name + ".obj", file_of(k.mesh, "obj"));
    save(k.name + "." + k.format, file_of(k.mesh, k.format));
    std::string points;  // the corners of its faces
    for (const VertexId v : k.mesh.face_vertices) {
      for (const double x : k.mesh.vertices[v]) points += test::digits(x) + " ";
      points += "\n";
    }
    save(k.name + ".points.txt", points);
    kinds.push_back({{"name", k.name},
                     {"dim", k.mesh.dim},
                     {"solid", k.solid},
                     {"builds", k.builds},
                     {"simple", k.simple},
                     {"files", {"obj", k.format}}});
  }
  for (const Cell& c : m.cells) {
    const std::string name = m.kinds[c.a].name + (c.a == c.b ? "--itself" : "--probe");
    std::string poses;
    for (const Step& s : c.steps) poses += text_of(s.pose) + "\n";
    save(name + ".txt", poses);
    save(name + ".motion.txt", text_of(c.start) + text_of(c.end) + "\n");
    save(name + ".json", scenario_of(m, c, name).dump(1));
    cells.push_back({{"name", name},
                     {"a", m.kinds[c.a].name},
                     {"b", m.kinds[c.b].name},
                     {"size", c.size},
                     {"meets", c.meets ? Json(*c.meets) : Json()},
                     {"steps", steps_of(c)}});
  }
  save("matrix.json", Json{{"kinds", kinds}, {"cells", cells}}.dump(1));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 4 && std::strcmp(argv[1], "--save") == 0) {
      const BodyOptions options;
      save_lrb(Body::load(argv[2], options).value(), argv[3]);
      return 0;
    }
    if (argc != 2 && argc != 3) throw InputError("usage: matrix_bodies DIR [NOISY] | --save MESH FILE.lrb");
    write_matrix(argv[1], argc == 3 ? std::atoi(argv[2]) : 4);
    return 0;
  } catch (const InputError& e) {
    std::fprintf(stderr, "matrix_bodies: %s\n", e.what());
    return 2;
  }
}
