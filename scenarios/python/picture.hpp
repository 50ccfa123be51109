#pragma once

#include "scenarios/python/recorded.hpp"

namespace lrb::python {

/// How a picture is to look, as Python gives it. None: as render() says.
struct PictureArguments {
  py::handle size, view_from, up, look_at, zoom, orthographic, wrappers, close_up, colour_by, transparent;
};

/// Calls bind(names...) with the names of PictureArguments, in their order.
template <class Bind>
void with_picture_arguments(const Bind& bind) {
  const py::none no;
  bind(py::arg("size") = no, py::arg("view_from") = no, py::arg("up") = no, py::arg("look_at") = no,
       py::arg("zoom") = no, py::arg("orthographic") = no, py::arg("wrappers") = no, py::arg("close_up") = no,
       py::arg("colour_by") = no, py::arg("transparent") = no);
}

/// Draws the end of a step of a run as a lrbscope.Picture. The lock must be held, and is not while it draws.
py::object draw(const Recorded& recorded, std::size_t step, const PictureArguments& given);

/// Encodes an (h, w, 3) or (h, w, 4) array as PNG.
py::bytes png_of(const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>& pixels);

}  // namespace lrb::python
