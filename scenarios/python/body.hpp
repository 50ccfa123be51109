#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "engine/query/world_box.hpp"
#include "scenarios/bodies/body.hpp"
#include "scenarios/python/arguments.hpp"

namespace lrb::python {

/// A body as Python has it: an LRB-rep, which does not change, and what is known of where it came from.
class Body {
 public:
  /// vertex_count: of the mesh; the vertices after these belong to pseudo faces.
  Body(bodies::LoadedBody loaded, std::size_t vertex_count);
  explicit Body(bodies::LoadedBody loaded);

  const LrbRep& rep() const { return *rep_; }
  const std::shared_ptr<const LrbRep>& shared() const { return rep_; }
  const std::vector<std::string>& notes() const { return notes_; }
  double build_seconds() const { return build_seconds_; }
  std::size_t vertex_count() const { return vertex_count_; }
  /// Returns what finds the body's box; made when it is first asked for.
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

/// Returns the body that an argument is; throws TypeError for anything else.
const Body& body(py::handle given, const char* what);
BodyPtr shared_body(py::handle given, const char* what);

void bind_body(py::module_& m);

}  // namespace lrb::python
