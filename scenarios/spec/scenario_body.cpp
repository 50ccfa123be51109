#include "scenarios/spec/scenario_body.hpp"

#include <algorithm>

#include "scenarios/spec/scenario_motion.hpp"

namespace lrb::spec {
namespace {

BuildOptions read_build(const io::JsonNode& node, std::uint64_t seed) {
  node.object({"patch_interior", "max_outer_faces", "lean", "seed"});
  BuildOptions o;
  o.seed = seed;
  if (const auto n = node.get("patch_interior"))
    o.patch_interior = static_cast<std::uint32_t>(n->integer(1, 1000));
  if (const auto n = node.get("max_outer_faces"))
    o.max_outer_faces = static_cast<std::uint32_t>(n->integer(4, 1000));
  if (const auto n = node.get("lean")) o.lean = n->boolean();
  if (const auto n = node.get("seed")) o.seed = n->integer(0, kAnySeed);
  return o;
}

generators::GeneratorValues read_parameters(const io::JsonNode& node,
                                            const generators::Generator& generator) {
  std::vector<std::string> known;
  for (const generators::GeneratorParameter& p : generator.parameters) known.emplace_back(p.name);
  node.object(known);
  generators::GeneratorValues values;
  for (const generators::GeneratorParameter& p : generator.parameters) {
    const auto n = node.get(p.name);
    if (!n) continue;
    values[p.name] = p.whole ? static_cast<double>(n->integer(static_cast<std::uint64_t>(p.least),
                                                              static_cast<std::uint64_t>(p.most)))
                             : n->number(p.least, p.most);
  }
  return values;
}

}  // namespace

BodySpec read_body(const io::JsonNode& node, const std::filesystem::path& folder, std::uint64_t seed) {
  node.object({"file", "generator", "parameters", "build", "pose"});
  BodySpec body;
  body.build.seed = seed;
  if (node.has("file") == node.has("generator")) node.fail("expected either \"file\" or \"generator\"");
  if (const auto file = node.get("file")) {
    if (node.has("parameters")) node.fail_key("parameters", "only a generator has parameters: remove it");
    if (file->string().empty()) file->fail("expected the name of a mesh or .lrb file");
    body.file = (folder / file->string()).lexically_normal().string();
  } else {
    std::vector<std::pair<std::string, const generators::Generator*>> known;
    for (const generators::Generator& g : generators::generators()) known.emplace_back(g.name, &g);
    const generators::Generator* generator = node.at("generator").choice(known);
    body.generator = generator->name;
    if (const auto parameters = node.get("parameters"))
      body.parameters = read_parameters(*parameters, *generator);
  }
  if (const auto build = node.get("build")) {
    body.build = read_build(*build, seed);
    const generators::Generator* generator = generators::find_generator(body.generator);
    for (const char* key : {"patch_interior", "max_outer_faces", "lean"})
      if (generator != nullptr && generator->make_rep != nullptr && build->has(key))
        build->fail_key(key, "the regions of this body are known by construction: remove it");
  }
  if (const auto pose = node.get("pose")) body.pose = read_pose(*pose);
  return body;
}

std::string read_name(const io::JsonNode& node) {
  const std::string name = node.string();
  const bool plain = !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!plain) node.fail("expected 1 to 64 letters, digits, - and _: the output folder is named after it");
  return name;
}

}  // namespace lrb::spec
