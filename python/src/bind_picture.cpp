#include <mutex>

#include "python/src/objects.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/record/moments.hpp"
#include <lrbscope/render/image.hpp>

namespace lrb::python {
namespace {

using View = pictures::FrameSpec::View;

int side(const py::handle& given) {
  const std::uint64_t n = count({given, "size"});
  if (n < 16 || n > 8192)
    throw InputError("size: expected two numbers from 16 to 8192, got " + std::to_string(n));
  return static_cast<int>(n);
}

/// The picture in terms of the run's spec, and whether the direction was given.
struct Wanted {
  pictures::FrameSpec frames;
  bool from_given = false;
};

/// Returns the direction of "x", "-y" and the like, or of three numbers.
Eigen::Vector3d direction(const Argument& arg) {
  if (!py::isinstance<py::str>(arg.given)) return vector(arg);
  const auto word = arg.given.cast<std::string>();
  const std::size_t sign = word.starts_with("-") ? 1 : 0;
  if (word.size() != sign + 1 || word[sign] < 'x' || word[sign] > 'z')
    throw InputError(std::string(arg.name) +
                     ": expected three numbers, 'x', 'y', 'z', '-x', '-y' or '-z', got " +
                     described(arg.given));
  return (sign == 1 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(word[sign] - 'x');
}

Wanted wanted(const Given& given) {
  Wanted out;
  pictures::FrameSpec& f = out.frames;
  f.width = 960;
  f.height = 720;
  if (const Argument size = given["size"]; !size.is_none()) {
    if (!py::isinstance<py::sequence>(size.given) || py::len(size.given) != 2)
      throw InputError("size: expected (width, height)");
    const auto sides = py::reinterpret_borrow<py::sequence>(size.given);
    f.width = side(sides[0]);
    f.height = side(sides[1]);
  }
  View view;
  const Argument view_from = given["view_from"], up = given["up"], look_at = given["look_at"];
  out.from_given = !view_from.is_none();
  if (out.from_given) view.from = direction(view_from);
  if (!up.is_none()) view.up = direction(up);
  for (const Eigen::Vector3d* v : {&view.from, &view.up})
    if (!v->allFinite() || !(v->squaredNorm() > 0))
      throw InputError(std::string(v == &view.from ? "view_from" : "up") +
                       ": expected a direction other than zero");
  if (!look_at.is_none()) view.look_at = vector(look_at);
  view.zoom = number(given["zoom"], 1);
  if (!(view.zoom > 0 && view.zoom < 1e6)) throw InputError("zoom: expected a number above 0");
  view.orthographic = flag(given["orthographic"]);
  view.wrapper = flag(given["wrappers"]);
  if (flag(given["close_up"])) view.camera = pictures::FrameSpec::Camera::contact;
  f.views = {view};
  f.colour_by = word(given["colour_by"], f.colour_by);
  f.transparent = flag(given["transparent"]);
  f.at = pictures::FrameSpec::At::events;
  return out;
}

/// Returns one frame. Pictures are drawn one at a time: fonts are shared.
frames::PaintedFrame paint(const Recorded& recorded, std::size_t step, Wanted wanted) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const frames::RecordedRun shown = recorded.shown();
  if (recorded.trace.events.empty()) throw InputError("nothing to draw: the trace contains no events");
  wanted.frames.events = {record::last_event(recorded.trace, step)};
  View& view = wanted.frames.views[0];
  if (!wanted.from_given && recorded.bodies.size() == 2 && !recorded.results->empty())
    view.from = frames::min_hidden(shown, view.up, view.from);
  frames::check_frames(shown, wanted.frames);
  return frames::paint_frames(shown, wanted.frames, record::kSilent).at(0);
}

py::array_t<std::uint8_t> pixels_of(const render::Image& image, bool alpha) {
  const py::ssize_t channels = alpha ? 4 : 3;
  py::array_t<std::uint8_t> out(
      {static_cast<py::ssize_t>(image.height()), static_cast<py::ssize_t>(image.width()), channels});
  std::uint8_t* to = out.mutable_data();
  for (const render::Rgba& p : image.pixels()) {
    *to++ = p.r;
    *to++ = p.g;
    *to++ = p.b;
    if (alpha) *to++ = p.a;
  }
  return out;
}

}  // namespace

py::object draw(const Recorded& recorded, std::size_t step, const Given& given) {
  Wanted what = wanted(given);
  const bool alpha = what.frames.transparent;
  frames::PaintedFrame frame;
  {
    const py::gil_scoped_release unlocked;
    frame = paint(recorded, step, std::move(what));
  }
  return py::module_::import("lrbscope._picture")
      .attr("Picture")(pixels_of(frame.image, alpha), frame.caption);
}

py::bytes png_of(const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>& pixels) {
  if (pixels.ndim() != 3 || (pixels.shape(2) != 3 && pixels.shape(2) != 4))
    throw InputError("expected a picture of shape (height, width, 3) or (height, width, 4), got " +
                     described(pixels));
  const auto channels = pixels.shape(2);
  render::Image image(static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)));
  const std::uint8_t* from = pixels.data();
  for (render::Rgba& p : image.pixels()) {
    p = {from[0], from[1], from[2], channels == 4 ? from[3] : std::uint8_t{255}};
    from += channels;
  }
  const std::vector<std::uint8_t> png = render::encode_png(image);
  return {reinterpret_cast<const char*>(png.data()), png.size()};
}

}  // namespace lrb::python
