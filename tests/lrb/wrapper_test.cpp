
#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/wrapper.hpp>

using namespace lrb;

namespace {
std::vector<FaceId> faces(std::initializer_list<FaceId> list) {
  return list;
}
}  // namespace

TEST_CASE("refining goes from the outermost wrapper to the real faces and back") {
  const LrbRep rep = shapes::stairs_2d();
  Wrapper w(rep);
  const auto outermost = faces({0, 1, 8, 9, 11, 12});
  CHECK(w.boundary() == outermost);
  CHECK(w.refine(1));
  CHECK_FALSE(w.refine(1));
  CHECK(w.boundary() == faces({0, 1, 2, 3, 6, 7, 8, 9, 10}));
  CHECK(w.refine(0));
  CHECK(w.boundary() == faces({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  CHECK(w.excluded() == std::vector<RegionId>{1, 0});
  CHECK(w.coarsen(0));
  CHECK(w.coarsen(1));
  CHECK_FALSE(w.coarsen(1));
  CHECK(w.boundary() == outermost);
}

TEST_CASE("the two modes differ in what happens to a region's other lids") {
  const LrbRep rep = shapes::dented_box();
  Wrapper regularised(rep), unregularised(rep, WrapperMode::unregularised);
  CHECK(regularised.refine_face(28));
  CHECK_FALSE(regularised.refine_face(29));  // gone with the region
  CHECK(unregularised.refine_face(28));
  CHECK_FALSE(unregularised.on_boundary(28));
  CHECK(unregularised.on_boundary(29));  // stays until refined itself
  CHECK(unregularised.on_boundary(18));  // the floor is there already
  CHECK(unregularised.boundary_size() == regularised.boundary_size() + 1);
  CHECK(unregularised.refine_face(29));
  CHECK(unregularised.boundary() == regularised.boundary());
  CHECK(unregularised.coarsen(0));
  CHECK(unregularised.boundary() == Wrapper(rep).boundary());
}

TEST_CASE("real faces cannot be refined") {
  const LrbRep rep = shapes::dented_box();
  Wrapper w(rep);
  CHECK_FALSE(w.refine_face(0));
  CHECK_FALSE(w.refine_face(20));
}
