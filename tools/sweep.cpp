#include <array>
#include <utility>

#include "tools/pose_lines.hpp"
#include "trace/trace_json_parts.hpp"
#include <lrbscope/core/file.hpp>

namespace lrb::tools {
namespace {

/// The motions of the command, each by two poses.
struct MotionLines : Located {
  static constexpr const char* kName = "motion";
  std::vector<io::PosePair> list;
  std::vector<Motion> motions;

  /// The bodies of a case. A does not move.
  struct Moved {
    const LrbRep &a, &b;
    const Motion& motion;
  };

  explicit MotionLines(const std::string& path) : list(io::read_motions(path)) {
    for (const io::PosePair& poses : list)
      places.push_back(printable_name(path) + ":" + std::to_string(poses.line));
  }
  void check(const LrbRep& a, const LrbRep& b) {
    check_query(a, Pose{}, b, Pose{});
    for (std::size_t i = 0; i < list.size(); ++i)
      at(i, [&] {
        for (const Pose* pose : {&list[i].start, &list[i].end}) check_query(a, Pose{}, b, *pose);
        motions.push_back(Motion::screw(list[i].start, list[i].end));
      });
  }
  std::size_t size() const { return list.size(); }
  Moved bodies(std::size_t i, const LrbRep& a, const LrbRep& b) const { return {a, b, motions[i]}; }
};

struct SweepQuestion : PosedQuestion {
  using Lines = MotionLines;
  static constexpr const char* kName = "sweep";
  static constexpr const char* kHelp =
      "Find the time of impact (first contact) for each motion of B; one JSON line per motion";
  FirstContactRequest request;
  bool features = false;
  FirstContactHistory reported;

  void add_files(App& app) {
    app.add_option("A", a, "Mesh or .lrb file; does not move")->required();
    app.add_option("B", b, "Mesh or .lrb file; moves")->required();
    app.add_option(
           "--motions", poses,
           "File with motions of B: lines of 24 numbers, the poses at t = 0 and t = 1 (3x4 each, row by row)")
        ->required();
  }
  void add_options(App& app) {
    app.add_option("--tolerance", request.tolerance, "T", "Maximum width of the interval of t [1e-9]");
    app.add_option("--budget", request.max_steps, "N", "Maximum number of steps [10000000]")
        ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 62);
    app.add_flag("--features", features, "Add the features (vertex, edge or face) in first contact");
    app.add_flag("--history", request.history,
                 "Add the intervals of t that were examined, with the result of each");
    app.add_flag("--convergence", draw.history,
                 "Add the convergence history: [work, t0, t1, lower and upper bound of the distance at t0]");
    add_draw_options(app, draw, "Draw the bodies at first contact, with ghosts of B along its motion", false);
  }
  void check() const { check_request(request); }

  FirstContactResult ask(const MotionLines::Moved& m, Workspace& workspace, bool watched) {
    if (watched) reported = {};
    return std::move(first_contact(m.a, Motion::still({}), m.b, m.motion, request, workspace,
                                   watched ? &reported : nullptr)
                         .value());
  }

  static void write_feature(trace::JsonWriter& w, const char* name, const Witness& witness) {
    if (witness.corner_count == 0) return;
    w.key(name).begin_object().member("face", witness.face);
    write_feature_of(w, witness);
    w.member("point", witness.point).end_object();
  }
  void write_contact(trace::JsonWriter& w, const FirstContactResult& result) const {
    w.member("pair", std::array{result.pair.a, result.pair.b});
    if (result.at_start) w.member("start", true);
    if (!result.at_start && !result.normal.isZero(0))
      w.member("normal", result.normal).member("speed", result.speed);
    if (result.passed) w.member("passed", true);
    if (!features) return;
    write_feature(w, "on_a", result.witness[0]);
    write_feature(w, "on_b", result.witness[1]);
  }
  static void write_history(trace::JsonWriter& w, const FirstContactResult& result) {
    w.key("history").begin_array();
    for (const FirstContactResult::Event& event : result.history) {
      w.begin_object().member("span", std::array{event.span.begin, event.span.end});
      w.member("pairs", event.pairs).member("free_until", event.free_until).end_object();
    }
    w.end_array();
  }
  void write(trace::JsonWriter& w, const FirstContactResult& result, const auto&, const auto& us) const {
    w.key("contact");
    result.outcome == MotionOutcome::undecided ? w.null() : w.value(result.is_contact());
    if (result.outcome != MotionOutcome::never) w.member("t0", result.t0).member("t1", result.t1);
    if (result.is_contact()) write_contact(w, result);
    if (result.grazing) w.member("grazing", true);
    if (!result.finished) w.member("finished", false);
    if (result.unresolved != Unresolved::nothing) w.member("unresolved", name_of(result.unresolved));
    if (is_inside(result.at_begin)) w.member("inside", to_string(result.at_begin));
    if (request.history) write_history(w, result);
    if (draw.history) trace::write_history(w, reported.history);
    us(w);
  }

  static auto picture(const FirstContactResult& result, const MotionLines::Moved& m,
                      const pictures::Look& look) {
    return pictures::picture_of(result, m.a, m.b, m.motion, look);
  }
  std::optional<report::Gnuplot> chart() const { return contact_chart(reported.history); }
};

}  // namespace

Command add_sweep(App& root, const Globals& globals) {
  return add_question<SweepQuestion>(root, globals);
}

}  // namespace lrb::tools
