#pragma once
/// Watching a search for a first contact, from outside the engine: derive from FirstContactProbe and give it
/// to first_contact(). The answer is the same as without; each time something is told the distance of the
/// bodies is measured once more.

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/query/motion/first_contact.hpp"

namespace lrb {

/// What is known of a first contact after some work.
struct ContactBounds {
  std::uint64_t work = 0;  ///< the sum of FirstContactCounters' spans, steps and exact_queries until then
  double t0 = 0;           ///< the bodies do not meet before, but in what is doubtful
  double t1 =
      std::numeric_limits<double>::infinity();  ///< they have met by then; infinite: no contact is known
  double lower = 0,
         upper = 0;  ///< hold the distance of the surfaces at t0, to about a hundredth of it
  friend bool operator==(const ContactBounds&, const ContactBounds&) = default;
};

class FirstContactProbe {
 public:
  virtual ~FirstContactProbe() = default;
  /// t0 rose, or a contact was found, or an earlier one than before: in the order of the work.
  virtual void bounds(const ContactBounds& known) = 0;
};

/// Keeps what it is told.
class FirstContactCourse final : public FirstContactProbe {
 public:
  void bounds(const ContactBounds& known) override { course.push_back(known); }
  std::vector<ContactBounds> course;
};

/// Does what first_contact() in first_contact.hpp does, and tells the probe what is known, after more and
/// more work.
FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request,
                                 FirstContactProbe& probe);

}  // namespace lrb
