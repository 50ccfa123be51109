#include "scenarios/python/boxes.hpp"

#include "engine/query/broad_phase.hpp"
#include "scenarios/python/body.hpp"

namespace lrb::python {
namespace {

using Boxes = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<Eigen::AlignedBox3d> boxes_of(const Boxes& given) {
  if (given.ndim() != 3 || given.shape(1) != 2 || given.shape(2) != 3)
    throw InputError("boxes: expected numbers of shape (n, 2, 3), got " + described(given));
  std::vector<Eigen::AlignedBox3d> out;
  for (py::ssize_t i = 0; i < given.shape(0); ++i) {
    const double* x = given.data(i, 0, 0);
    out.emplace_back(Eigen::Vector3d(x[0], x[1], x[2]), Eigen::Vector3d(x[3], x[4], x[5]));
  }
  return out;
}

py::array_t<std::uint32_t> pairs_of(SweepAndPrune& sweep, const Boxes& given) {
  const std::vector<BodyPair>& pairs = sweep.update(boxes_of(given));
  static_assert(sizeof(BodyPair) == 2 * sizeof(std::uint32_t));
  return py::array_t<std::uint32_t>({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}},
                                    reinterpret_cast<const std::uint32_t*>(pairs.data()));
}

}  // namespace

void bind_boxes(py::module_& m) {
  py::class_<SweepAndPrune>(
      m, "SweepAndPrune",
      R"(The broad phase: finds which of many boxes meet, by sort and sweep; quick if they have moved little.

>>> boxes = [cube.box(), cube.box(shifted(0.5, 0, 0)), cube.box(shifted(9, 0, 0))]
>>> SweepAndPrune().update(boxes).tolist()
[[0, 1]])")
      .def(py::init<>())
      .def("update", &pairs_of, py::arg("boxes"),
           "update(boxes)\n\nReturns the pairs of boxes with a point in common, (p, 2) uint32 "
           "ascending. boxes: (n, 2, 3) float, least\n"
           "and greatest coordinates.");
}

}  // namespace lrb::python
