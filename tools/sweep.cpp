#include <array>
#include <memory>
#include <utility>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/io/poses.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/pose_lines.hpp"
#include "tools/terminal.hpp"
#include "trace/trace_json_parts.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::cli {
namespace {

struct SweepOptions {
  std::string a, b, motions;
  FirstContactRequest request;
  std::uint32_t repeat = 0;
  bool features = false;
  DrawOptions draw;
  bodies::Corners corners = bodies::Corners::joined;
};

void write_feature_and_point(trace::JsonWriter& w, const char* name, const Witness& witness) {
  if (witness.corner_count == 0) return;
  w.key(name).begin_object().member("face", witness.face);
  write_feature_of(w, witness);
  w.member("point", witness.point).end_object();
}

void write_contact(trace::JsonWriter& w, const FirstContactResult& result, const SweepOptions& o) {
  w.member("pair", std::array{result.pair.a, result.pair.b});
  if (result.at_start) w.member("start", true);
  if (!result.at_start && !result.normal.isZero(0))
    w.member("normal", result.normal).member("speed", result.speed);
  if (result.passed) w.member("passed", true);
  if (!o.features) return;
  write_feature_and_point(w, "on_a", result.witness[0]);
  write_feature_and_point(w, "on_b", result.witness[1]);
}

void write_history(trace::JsonWriter& w, const FirstContactResult& result) {
  w.key("history").begin_array();
  for (const FirstContactResult::Event& event : result.history) {
    w.begin_object().member("span", std::array{event.span.begin, event.span.end});
    w.member("pairs", event.pairs).member("free_until", event.free_until).end_object();
  }
  w.end_array();
}

std::string line_of(std::size_t motion, const FirstContactResult& result,
                    const std::vector<ContactBounds>& history, const SweepOptions& o, double us) {
  return trace::json_text(trace::JsonWriter::kCompact, [&](trace::JsonWriter& w) {
    w.begin_object().member("motion", std::uint64_t{motion});
    w.key("contact");
    result.outcome == MotionOutcome::undecided ? w.null() : w.value(result.is_contact());
    if (result.outcome != MotionOutcome::never) w.member("t0", result.t0).member("t1", result.t1);
    if (result.is_contact()) write_contact(w, result, o);
    if (result.grazing) w.member("grazing", true);
    if (!result.finished) w.member("finished", false);
    if (result.unresolved != Unresolved::nothing) w.member("unresolved", name_of(result.unresolved));
    if (result.at_begin == Relation::a_inside_b || result.at_begin == Relation::b_inside_a)
      w.member("inside", to_string(result.at_begin));
    if (o.request.history) write_history(w, result);
    if (o.draw.history) trace::write_history(w, history);
    if (o.repeat > 0) w.member("us", us);
    w.end_object();
  });
}

/// The motions of B, each checked, so that an error is reported before the first answer.
std::vector<Motion> motions_of(const std::vector<io::PosePair>& list, const std::string& file,
                               const LrbRep& a, const LrbRep& b) {
  std::vector<Motion> motions;
  for (const io::PosePair& poses : list) {
    try {
      for (const Pose* pose : {&poses.start, &poses.end}) check_query(a, Pose{}, b, *pose);
      motions.push_back(Motion::screw(poses.start, poses.end));
    } catch (const InputError& e) {
      throw InputError(file + ":" + std::to_string(poses.line) + ": " + e.what());
    }
  }
  return motions;
}

int run_sweep(const SweepOptions& o, const Globals& globals) {
  const std::vector<io::PosePair> list = io::read_motions(o.motions);
  check_request(o.request);
  const render::Look look = look_of(o.draw);
  const auto loaded = load_noted(o.a, o.b, o.corners, globals);
  const bodies::LoadedBody &a = loaded[0], &b = loaded[1];
  check_query(a.rep, Pose{}, b.rep, Pose{});
  const std::vector<Motion> motions = motions_of(list, printable_name(o.motions), a.rep, b.rep);
  const Motion still = Motion::still({});
  Workspace workspace;
  Progress progress("sweep", motions.size(), globals.quiet);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const auto run_query = [&](FirstContactProbe* probe) {
      return std::move(first_contact(a.rep, still, b.rep, motions[i], o.request, workspace, probe).value());
    };
    FirstContactHistory reported;
    const FirstContactResult result = run_query(o.draw.is_watched() ? &reported : nullptr);
    print(line_of(i, result, reported.history, o,
                  o.repeat > 0 ? median_us(o.repeat, [&] { run_query(nullptr); }) : 0));
    if (!o.draw.picture.empty())
      run::write_picture(run::picture_of(result, a.rep, b.rep, motions[i], look),
                         picture_name(o.draw.picture, i, motions.size()));
    if (!o.draw.chart.empty())
      report::draw(contact_chart(reported.history), picture_name(o.draw.chart, i, motions.size()));
    progress.set(i + 1);
  }
  return kOk;
}

}  // namespace

Command add_sweep(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "sweep", "Find the time of impact (first contact) for each motion of B; one JSON line per motion");
  const auto o = std::make_shared<SweepOptions>();
  app->add_option("A", o->a, "Mesh or .lrb file; does not move")->required();
  app->add_option("B", o->b, "Mesh or .lrb file; moves")->required();
  app->add_option(
         "--motions", o->motions,
         "File with motions of B: lines of 24 numbers, the poses at t = 0 and t = 1 (3x4 each, row by row)")
      ->required();
  app->add_option("--tolerance", o->request.tolerance, "T", "Maximum width of the interval of t [1e-9]");
  app->add_option("--budget", o->request.max_steps, "N", "Maximum number of steps [10000000]")
      ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 62);
  app->add_flag("--features", o->features, "Add the features (vertex, edge or face) in first contact");
  app->add_flag("--history", o->request.history,
                "Add the intervals of t that were examined, with the result of each");
  app->add_flag("--convergence", o->draw.history,
                "Add the convergence history: [work, t0, t1, lower and upper bound of the distance at t0]");
  add_draw_options(*app, o->draw, "Draw the bodies at first contact, with ghosts of B along its motion",
                   false);
  add_repeat_option(*app, o->repeat, "motion");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_sweep(*o, globals); }};
}

}  // namespace lrb::cli
