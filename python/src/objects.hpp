#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "python/src/functions.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/frames/frames.hpp"
#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/world_box.hpp>

namespace lrb::python {

/// The Python class Body: an immutable LRB-rep, and its origin.
class Body {
 public:
  /// vertex_count: of the mesh; later vertices belong to pseudo faces.
  Body(bodies::LoadedBody loaded, std::size_t vertex_count);
  explicit Body(bodies::LoadedBody loaded);

  const LrbRep& rep() const { return *rep_; }
  const std::shared_ptr<const LrbRep>& shared() const { return rep_; }
  const std::vector<std::string>& notes() const { return notes_; }
  double build_seconds() const { return build_seconds_; }
  std::size_t vertex_count() const { return vertex_count_; }
  /// Returns the helper that finds the body's box; made on first use.
  const BodyExtent& extent() const;

 private:
  std::shared_ptr<const LrbRep> rep_;
  std::vector<std::string> notes_;
  double build_seconds_;
  std::size_t vertex_count_;
  mutable std::once_flag once_;
  mutable std::optional<BodyExtent> extent_;
};

using BodyPtr = std::shared_ptr<Body>;

/// Returns the body of an argument: a Body, or an object with vertices and faces, whose body lives until the
/// call from Python ends. Throws TypeError for any other object.
const Body& body(const Argument& arg);
BodyPtr shared_body(const Argument& arg, const char* expected = "a Body");

/// The arguments a, b, pose_a, and pose_b or poses_b of a query.
struct TwoBodies {
  explicit TwoBodies(const Given& given);

  const Body &a, &b;
  Pose pose_a;
  Poses poses_b;

  const Pose& pose_b() const { return poses_b.first; }
};

/// The Python class Trace: the input of the pictures and pages of scenarios/run, with shared bodies.
class Recorded {
 public:
  std::vector<std::shared_ptr<const LrbRep>> bodies;  ///< A and B, or A alone
  trace::Trace trace;
  std::shared_ptr<std::vector<CollideResult>> results = std::make_shared<std::vector<CollideResult>>();
  std::vector<trace::TreeShape> trees;
  std::vector<std::string> notes;
  std::string title, purpose;

  /// Returns the data that frames are drawn from; this object must outlive it.
  frames::RecordedRun shown() const;
};

/// Takes ownership of a recording.
std::shared_ptr<Recorded> recorded_of(record::Recording recording, const spec::Scenario& scenario);

/// Draws the end of a step of a run as a lrbscope.Picture, with the options of render(). The GIL must be
/// held, and is released while drawing.
py::object draw(const Recorded& recorded, std::size_t step, const Given& given);

/// Encodes an (h, w, 3) or (h, w, 4) array as PNG.
py::bytes png_of(const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>& pixels);

// Each binds one subject. module.cpp calls them in an order that defines each class before its first use.
void bind_answers(py::module_& m);
void bind_body(py::module_& m);
void bind_collide(py::module_& m);
void bind_distances(py::module_& m);
void bind_explain(py::module_& m);
void bind_recorded(py::module_& m);
void bind_rows(py::module_& m);
void bind_scene(py::module_& m);
void bind_wrapper(py::module_& m);

}  // namespace lrb::python
