// collide A B X Y Z: the relation of A and B, B moved by (X, Y, Z), and the pairs of faces that intersect.
#include <cstdlib>
#include <exception>
#include <iostream>

#include <lrbscope/body.hpp>
#include <lrbscope/collide.hpp>

int main(int argc, char** argv) try {
  if (argc != 6) throw lrb::InputError("usage: collide A B X Y Z");
  // Files: OBJ, STL, PLY, OFF or .lrb. value() throws an InputError that names the file and the line.
  const lrb::Body a = lrb::Body::load(argv[1]).value();
  const lrb::Body b = lrb::Body::load(argv[2]).value();
  const lrb::Pose pose_a;  // the identity
  const lrb::Pose pose_b =
      lrb::Pose::translation({std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5])});

  const lrb::CollideResult result = lrb::collide(a, pose_a, b, pose_b);

  std::cout << lrb::name_of(result.relation) << ", " << result.pairs.size() << " pairs of triangles\n";
  for (const lrb::SimplexPair& pair : result.pairs)  // a polygon consists of several triangles
    std::cout << "face " << a.rep().face_of_simplex(pair.a) << " of A, face "
              << b.rep().face_of_simplex(pair.b) << " of B\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
