#include "scenarios/paper/report_pictures.hpp"

#include <algorithm>
#include <optional>

#include "engine/core/error.hpp"
#include "render/overlay.hpp"
#include "render/png.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/paper/close_up.hpp"
#include "scenarios/paper/heat_map.hpp"
#include "scenarios/paper/icicle.hpp"
#include "scenarios/run/run_report.hpp"

namespace lrb::paper {
namespace {

const PaperObject& object_called(const PaperReport& r, const std::string& name) {
  return *std::find_if(r.objects.begin(), r.objects.end(),
                       [&](const PaperObject& o) { return o.name == name; });
}

std::string collision_words(const CloseUp& c) {
  return "number " + std::to_string(c.collision) + ", " + render::group_digits(c.comparisons) +
         " face tests in " + std::to_string(c.steps.size()) +
         (c.steps.size() == 1 ? " time step" : " time steps");
}

std::string heat_caption(const PaperPair& pair, const CloseUp& easiest, const CloseUp& hardest,
                         std::uint32_t collisions) {
  return "Face tests of each face of " + pair.a.name + " and of " + pair.x.name +
         " by the paper's recursion, in the easiest of their " + render::group_digits(collisions) +
         " collisions (" + collision_words(easiest) + ") and in the hardest (" + collision_words(hardest) +
         "). Each body stands alone, seen from where the other one is, as the wrapper that the last time "
         "step "
         "left of it: lids that stayed closed, and bare real faces. One logarithmic scale for all panels.";
}

std::string tree_caption(const PaperPair& pair, const CloseUp& c) {
  const ContactStep& step = c.steps[busiest_step(c)];
  return pair.a.name + " against " + pair.x.name + ", collision " + std::to_string(c.collision) +
         ", time step " + std::to_string(step.step) + " after the first contact, " +
         render::group_digits(step.counts[0].comparisons) +
         " face tests by the paper's recursion. A row is a depth, from the outermost wrapper down; a box is "
         "a "
         "region, under the one that hid it; at the ends, real faces, or all that a closed region hides. A "
         "box is as wide as the faces of the final wrapper in it are many. Open the file and point at a box "
         "to read what it is.";
}

struct CloseUps {
  PaperPair pair;
  CloseUp easiest, hardest;
};

/// Returns nothing if the experiment does not report them.
std::optional<CloseUps> close_ups_of(const PaperReport& r) {
  if (!r.experiment.reports(PaperPart::heat_maps) && !r.experiment.reports(PaperPart::refinement_tree))
    return std::nullopt;
  const PaperPair pair{r.objects.front(), object_called(r, r.experiment.close_up)};
  const auto [least, most] = easiest_and_hardest(r.steps, pair.x.name);
  return CloseUps{pair, close_up(pair, least, r.experiment.protocol, r.steps),
                  close_up(pair, most, r.experiment.protocol, r.steps)};
}

}  // namespace

void check_records(const PaperReport& r) {
  for (const ContactStep& s : r.steps)
    if (s.collision >= r.experiment.protocol.collisions)
      throw InputError("the records hold collision " + std::to_string(s.collision) + " with " + s.object +
                       ", numbered from 0, but the experiment has " +
                       std::to_string(r.experiment.protocol.collisions) +
                       ": give the options that the records were made with, such as --collisions");
  static_cast<void>(close_ups_of(r));
}

void draw_close_ups(const PaperReport& r, const std::string& folder, report::Page& page,
                    std::vector<std::string>& notes) {
  const std::optional<CloseUps> c = close_ups_of(r);
  if (!c) return;
  if (r.experiment.reports(PaperPart::heat_maps)) try {
      render::write_png(draw_heat_maps(c->pair, c->easiest, c->hardest), folder + "/heat_maps.png");
      run::add_figure(page, folder, "Face tests over the bodies",
                      heat_caption(c->pair, c->easiest, c->hardest, r.experiment.protocol.collisions),
                      "heat_maps.png");
    } catch (const EnvironmentError& e) {
      notes.push_back(std::string("heat maps were not drawn: ") + e.what());
    }
  if (r.experiment.reports(PaperPart::refinement_tree)) {
    io::write_text(folder + "/refinement_tree.svg", icicle_svg(c->pair, c->hardest));
    run::add_live_figure(page, folder, "The refinement tree of one collision",
                         tree_caption(c->pair, c->hardest), "refinement_tree.svg");
  }
}

}  // namespace lrb::paper
