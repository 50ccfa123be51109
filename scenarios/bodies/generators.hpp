#pragma once
/// Generates bodies: seeded, closed, oriented outward, free of self-intersections.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::generators {

struct GeneratorParameter {
  const char* name;
  double fallback, least, most;
  bool whole;        ///< accepts integers only
  const char* what;  ///< with its unit
};

using GeneratorValues = std::map<std::string, double>;

struct Generator {
  const char* name;
  const char* purpose;
  int dim;
  std::vector<GeneratorParameter> parameters;
  Mesh (*make)(const GeneratorValues& values, std::uint64_t seed);  ///< every parameter has a value
  /// Makes a body whose regions are known by construction, without a builder; null if they are not.
  LrbRep (*make_rep)(const GeneratorValues& values, std::uint64_t seed) = nullptr;
};

std::span<const Generator> generators();
/// Returns a generator by name, or null if it is unknown.
const Generator* find_generator(const std::string& name);

/// Makes a body. Parameters not in `values` have the generator's defaults. Throws InputError for an unknown
/// name or parameter and for a value out of range.
Mesh generate(const std::string& name, const GeneratorValues& values = {}, std::uint64_t seed = 1);
/// Makes the same body with its regions. Returns nullopt if the generator does not know them.
std::optional<LrbRep> generate_rep(const std::string& name, const GeneratorValues& values = {},
                                   std::uint64_t seed = 1);

// The generators' functions (generated_solids.cpp, fractal.cpp). All parameters have values, checked by
// generate().

Mesh rock(const GeneratorValues& v, std::uint64_t seed);
Mesh ball(const GeneratorValues& v, std::uint64_t seed);
Mesh knot(const GeneratorValues& v, std::uint64_t seed);
Mesh gear(const GeneratorValues& v, std::uint64_t seed);
Mesh cog2d(const GeneratorValues& v, std::uint64_t seed);
Mesh bowl(const GeneratorValues& v, std::uint64_t seed);
Mesh stick(const GeneratorValues& v, std::uint64_t seed);
Mesh pot(const GeneratorValues& v, std::uint64_t seed);
Mesh island(const GeneratorValues& v, std::uint64_t seed);
Mesh fractal(const GeneratorValues& v, std::uint64_t seed);
LrbRep fractal_rep(const GeneratorValues& v, std::uint64_t seed);

/// Adds a triangle.
inline void add_triangle(Mesh& mesh, VertexId a, VertexId b, VertexId c) {
  const VertexId corners[3] = {a, b, c};
  mesh.add_face(corners);
}

/// Two bodies that reach through each other, at distances far below their sizes, as in fit checks of CAD.
struct Interlocked {
  std::string name;
  Mesh a, b;
  Pose pose_b;  ///< A's is the identity
};

/// Makes two linked rings, a chain, a shaft in a sleeve, a thread, and a cable in a bent duct. Their rows
/// have `fine` times as many faces as the coarsest ones: about 290 fine^2 faces a body, of the chain twice as
/// many.
std::vector<Interlocked> interlocked(int fine);

// The fractal bodies of the paper's section 4: a basic shape with repeated local detail, as dents under lids.
// The regions are known by construction, without a builder.

struct FractalSpec {
  std::string name = "fractal";
  std::uint32_t real_faces = 2004;
  std::uint32_t total_faces = 2532;  ///< real and pseudo
  std::uint64_t seed = 1;
  std::uint32_t outer_faces = 7;  ///< of the outermost wrapper: 7 or 6
};

/// Makes a body with exactly these numbers of faces; its size is about 2. The basic shape is a pentagonal
/// prism (7 faces), or the stella octangula (24 faces, not convex) in a cube, whose 6 faces are the lids of
/// its first region. The body is closed and free of self-intersections (a dent stays within the
/// angles available at its face's edges; tests prove it exactly for the paper's bodies). All coordinates are
/// integer multiples of one power of two, so that corners of one face are coplanar in double arithmetic, and
/// so are lids and the rims they cover.
///
/// Every dent turns one face into a lid (a pseudo face) and adds 3 to 11 faces, which limits the possible
/// numbers. Throws InputError unless (real_faces - 7) / pseudo faces is between 2.5 and 7; for the star,
/// (real_faces - 24) / (pseudo faces - 6).
LrbRep fractal_body(const FractalSpec& spec);

/// Returns the paper's table 1: objects A to H. The paper says that they share a basic non-convex shape.
/// Their numbers of real faces are all 4 modulo 5, those of pseudo faces all even, and B has 24 x 6 real and
/// 24 x 1 pseudo faces: as if a detail turned one face into six, and B were a shape of 24 faces, each with
/// one detail. This is why the basic shape is a star of 24 faces.
std::span<const FractalSpec> paper_objects();

}  // namespace lrb::generators
