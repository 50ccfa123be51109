#include "scenarios/bodies/generators.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "trace/json_read.hpp"
#include <lrbscope/error.hpp>

namespace lrb::generators {
namespace {

std::vector<Generator> make_generators() {
  return {
      {"rock",
       "a rock with bumps and craters (a ball with a radius that varies with direction)",
       3,
       {{"frequency", 16, 2, 512, true,
         "subdivisions of an icosahedron's edge; the body has 20 * frequency^2 faces"},
        {"radius", 1, 1e-3, 1e3, false, "mean radius"},
        {"bumps", 0.22, 0, 0.5, false, "height of the bumps, relative to the radius"},
        {"craters", 9, 0, 60, true, "number of craters"}},
       rock},
      {"knot",
       "a tube along a torus knot",
       3,
       {{"p", 2, 1, 9, true, "turns around the axis"},
        {"q", 3, 1, 9, true, "turns around the ring"},
        {"radius", 1, 1e-3, 1e3, false, "radius of the ring's centre line"},
        {"swing", 0.4, 0.05, 0.9, false,
         "distance of the knot from the ring's centre line, relative to the radius"},
        {"tube", 0.17, 0.01, 0.4, false, "radius of the tube, relative to the ring's"},
        {"segments", 220, 12, 20000, true, "number of segments along the tube"},
        {"sides", 12, 3, 500, true,
         "number of sides around the tube; the body has 2 * sides * segments faces"}},
       knot},
      {"gear",
       "a toothed wheel with a bore",
       3,
       {{"teeth", 16, 4, 400, true, "number of teeth"},
        {"radius", 1, 1e-3, 1e3, false, "radius to half the height of the teeth"},
        {"depth", 0.2, 0.02, 0.5, false, "height of the teeth, relative to the radius"},
        {"bore", 0.35, 0.05, 0.7, false, "radius of the bore, relative to the radius"},
        {"thickness", 0.4, 0.02, 4, false, "thickness of the wheel, relative to its radius"},
        {"rings", 5, 1, 200, true, "number of rings of faces between bore and teeth"},
        {"points", 10, 4, 200, true, "number of points of a tooth's outline"}},
       gear},
      {"ball",
       "a ball: a subdivided icosahedron",
       3,
       {{"frequency", 10, 1, 512, true,
         "subdivisions of an icosahedron's edge; the body has 20 * frequency^2 faces"},
        {"radius", 1, 1e-3, 1e3, false, "radius"}},
       ball},
      {"bowl",
       "half of a thick hollow ball, open towards +z",
       3,
       {{"radius", 1, 1e-3, 1e3, false, "outer radius"},
        {"wall", 0.15, 0.01, 0.9, false, "thickness, relative to the radius"},
        {"segments", 48, 6, 2000, true, "number of segments around the axis"},
        {"rows", 14, 2, 1000, true, "number of rows from the bottom to the rim"}},
       bowl},
      {"stick",
       "a round stick with domed ends along z",
       3,
       {{"length", 2, 1e-3, 1e3, false, "length from end to end"},
        {"radius", 0.12, 1e-4, 1e3, false, "radius of the stick"},
        {"segments", 20, 6, 1000, true, "number of segments around the axis"},
        {"rows", 20, 1, 2000, true, "number of rows along the axis"}},
       stick},
      {"pot",
       "a pot with a wide cavity under a narrow mouth towards +z, which a single lid can close",
       3,
       {{"radius", 1, 1e-3, 1e3, false, "outer radius"},
        {"height", 1.6, 0.2, 10, false, "height, relative to the radius"},
        {"wall", 0.18, 0.02, 0.45, false, "thickness, relative to the radius"},
        {"mouth", 0.25, 0.02, 0.7, false, "radius of the mouth, relative to the radius"},
        {"segments", 40, 6, 2000, true, "number of segments around the axis"},
        {"rows", 8, 1, 1000, true, "number of rows of faces on each straight part"}},
       pot},
      {"island",
       "a 2D body: a non-convex outline with detail at several scales",
       2,
       {{"radius", 1, 1e-3, 1e3, false, "radius of the coarse outline"},
        {"levels", 3, 0, 7, true, "number of scales of detail; each multiplies the edges by four"},
        {"depth", 0.27, 0, 0.32, false,
         "depth of a bay, relative to the length of the edge that it is cut into"}},
       island},
      {"cog2d",
       "a 2D body: a toothed disk",
       2,
       {{"teeth", 9, 3, 1000, true, "number of teeth"},
        {"radius", 1, 1e-3, 1e3, false, "radius to half the height of the teeth"},
        {"depth", 0.25, 0.02, 0.8, false, "height of the teeth, relative to the radius"},
        {"points", 6, 4, 200, true, "number of points of a tooth's outline"}},
       cog2d},
      {"fractal",
       "a fractal body of the paper: dents within dents, with regions known by construction",
       3,
       {{"real_faces", 2004, 7, 200000, true, "number of faces of the body; the default is object D's"},
        {"total_faces", 2532, 7, 300000, true,
         "number of real and pseudo faces; real_faces - 7 must be 2.5 to 7 times the number of pseudo faces"},
        {"outer_faces", 7, 6, 7, true, "7: dents in a prism; 6: in a star of 24 faces, inside a cube"}},
       fractal,
       fractal_rep},
  };
}

std::vector<std::string> names_of(const std::vector<GeneratorParameter>& parameters) {
  std::vector<std::string> names;
  for (const GeneratorParameter& p : parameters) names.emplace_back(p.name);
  return names;
}

double checked(const Generator& g, const GeneratorParameter& p, double x) {
  if (x >= p.least && x <= p.most && (!p.whole || x == std::floor(x))) return x;
  std::ostringstream message;
  message << "generator " << g.name << ": " << p.name << " (" << p.what << ") is " << x << ": expected a "
          << (p.whole ? "whole " : "") << "number from " << p.least << " to " << p.most;
  throw InputError(message.str());
}

const Generator& known_generator(const std::string& name) {
  if (const Generator* g = find_generator(name)) return *g;
  std::vector<std::string> known;
  for (const Generator& k : generators()) known.emplace_back(k.name);
  throw InputError("unknown generator \"" + name + "\"" + io::suggestion(name, known));
}

/// Returns the values, with defaults for those not in `values`. Throws for unknown parameters and values out
/// of range.
GeneratorValues all_values(const Generator& g, const GeneratorValues& values) {
  const std::vector<std::string> known = names_of(g.parameters);
  for (const auto& [key, value] : values)
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw InputError(std::string("generator ") + g.name + ": unknown parameter \"" + key + "\"" +
                       io::suggestion(key, known));
  GeneratorValues all;
  for (const GeneratorParameter& p : g.parameters) {
    const auto it = values.find(p.name);
    all[p.name] = checked(g, p, it == values.end() ? p.fallback : it->second);
  }
  return all;
}

}  // namespace

std::span<const Generator> generators() {
  static const std::vector<Generator> all = make_generators();
  return all;
}

const Generator* find_generator(const std::string& name) {
  for (const Generator& g : generators())
    if (name == g.name) return &g;
  return nullptr;
}

Mesh generate(const std::string& name, const GeneratorValues& values, std::uint64_t seed) {
  const Generator& g = known_generator(name);
  Mesh mesh = g.make(all_values(g, values), seed);
  mesh.name = name;
  return mesh;
}

std::optional<LrbRep> generate_rep(const std::string& name, const GeneratorValues& values,
                                   std::uint64_t seed) {
  const Generator& g = known_generator(name);
  if (g.make_rep == nullptr) return std::nullopt;
  return g.make_rep(all_values(g, values), seed);
}

}  // namespace lrb::generators
