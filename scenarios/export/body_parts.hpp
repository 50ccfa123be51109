#pragma once
/// Makes models of bodies, wrappers and contacts.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/export/model.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/work.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::exchange {

/// One body in its state at a moment.
struct BodyMoment {
  const LrbRep* rep = nullptr;
  const Wrapper* wrapper = nullptr;  ///< null: not requested
  Pose pose;
  const trace::TreeShape* tree = nullptr;  ///< the traversed tree; null if not recorded
};

/// The content of a model, and its colouring.
struct Moment {
  std::string title;
  std::vector<BodyMoment> bodies;  ///< A and B, or A alone
  /// The events of the time step so far, used for counters; nullopt: no events, and no such columns.
  std::optional<std::span<const trace::Event>> events;
  std::span<const ContactRegion> contacts;
  render::FrameSpec::ColourBy colour_by = render::FrameSpec::ColourBy::kind;
  render::FrameSpec::ColourPer colour_per = render::FrameSpec::ColourPer::face;
};

struct Wanted {
  bool body = false, wrapper = false, contacts = false;
  bool side[2] = {true, true};  ///< of A's and B's
};

/// Returns the model of a moment. Its columns, -1 where not applicable:
/// - side: 0 A, 1 B; kind: 0 pseudo face, 1 real face, 2 contact
/// - face: its number in the LRB-rep; real faces are numbered as in the mesh's file
/// - region: the one behind a pseudo face, or around a real face; layer: the builder's pass that made it
/// - level: the number of regions between the face and the outside
/// - distance: proven maximum distance of the face's points from the body (the mesh's unit)
/// - with events: tests, hits, misses, refinements, contacts: as in trace::FaceCounts
/// - with a count to colour by: value, as it colours
/// - with contacts: contact, the number of the contact region, and its length, area and depth
Model make_model(const Moment& moment, const Wanted& wanted);

/// Returns the wrapper of the regions of the builder's first `layers` passes; 0: the body itself.
Wrapper wrapper_of_layers(const LrbRep& rep, std::uint32_t layers);

/// Returns the finest wrapper with at most `most` faces obtained by refining regions in order of decreasing
/// deviation of their lids. Throws InputError if the outermost one has more.
Wrapper wrapper_of_faces(const LrbRep& rep, std::uint32_t most);

}  // namespace lrb::exchange
