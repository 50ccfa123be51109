#pragma once
/// The generators' functions, in one file for each idea. All parameters have their values, checked by
/// generate().

#include "scenarios/bodies/generators/generators.hpp"

namespace lrb::generators {

Mesh rock(const GeneratorValues& v, std::uint64_t seed);     // rock.cpp
Mesh ball(const GeneratorValues& v, std::uint64_t seed);     // rock.cpp
Mesh knot(const GeneratorValues& v, std::uint64_t seed);     // knot.cpp
Mesh gear(const GeneratorValues& v, std::uint64_t seed);     // gear.cpp
Mesh cog2d(const GeneratorValues& v, std::uint64_t seed);    // gear.cpp
Mesh bowl(const GeneratorValues& v, std::uint64_t seed);     // lathe.cpp
Mesh stick(const GeneratorValues& v, std::uint64_t seed);    // lathe.cpp
Mesh pot(const GeneratorValues& v, std::uint64_t seed);      // lathe.cpp
Mesh island(const GeneratorValues& v, std::uint64_t seed);   // island.cpp
Mesh fractal(const GeneratorValues& v, std::uint64_t seed);  // fractal_generator.cpp
LrbRep fractal_rep(const GeneratorValues& v, std::uint64_t seed);

/// Adds a triangle.
inline void add_triangle(Mesh& mesh, VertexId a, VertexId b, VertexId c) {
  const VertexId corners[3] = {a, b, c};
  mesh.add_face(corners);
}

/// Makes a 2D mesh of a closed polygon in the plane, counter-clockwise.
Mesh polygon_2d(const std::vector<Eigen::Vector2d>& outline);  // island.cpp

}  // namespace lrb::generators
