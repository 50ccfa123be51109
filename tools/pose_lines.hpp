#pragma once
/// What commands that answer a query for each pose of B share: files and poses, parts of their lines,
/// pictures, and charts of the convergence of bounds.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/pictures/answer_picture.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/report/chart.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::tools {

/// Writes the closest feature of a face: its kind, and the vertices that span it.
inline void write_feature_of(trace::JsonWriter& w, const Witness& witness) {
  static constexpr const char* kNames[] = {"vertex", "edge", "face"};
  w.member("feature", kNames[witness.corner_count - 1]);
  w.member("vertices", std::span(witness.corners).first(static_cast<std::size_t>(witness.corner_count)));
}

/// Returns the median time in microseconds of `repeat` calls of run_query(); repeat > 0.
template <class Query>
double median_us(std::uint32_t repeat, const Query& run_query) {
  std::vector<double> us;
  for (std::uint32_t i = 0; i < repeat; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    run_query();
    us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
  }
  const std::size_t median = us.size() / 2;
  std::nth_element(us.begin(), us.begin() + static_cast<std::ptrdiff_t>(median), us.end());
  return us[median];
}

/// Calls a function for a line of a file.
struct Located {
  /// Calls run_query(), and prefixes the message of an InputError with the location.
  template <class Query>
  auto at(std::size_t i, const Query& run_query) const {
    try {
      return run_query();
    } catch (const InputError& e) {
      throw InputError(places[i] + ": " + e.what());
    }
  }

  std::vector<std::string> places;  ///< in the file
};

/// The poses of a command.
struct PoseLines : Located {
  static constexpr const char* kName = "pose";
  std::vector<Pose> poses;

  /// Reads a file of poses. Without one, B stays in place.
  explicit PoseLines(const std::string& path);
  /// Throws InputError unless the bodies can be queried at every pose. Called before anything is printed.
  void check(const LrbRep& a, const LrbRep& b) const;
  std::size_t size() const { return poses.size(); }
  pictures::PosedBodies bodies(std::size_t i, const LrbRep& a, const LrbRep& b) const {
    return {a, {}, b, poses[i]};
  }
};

/// The files of a command about A and poses of B.
struct PosedFiles {
  bodies::Corners corners = bodies::Corners::joined;
  std::string a, b, poses;
};
/// Adds A, B and --poses.
void add_posed_files(App& app, PosedFiles& files);

/// Returns a picture's file: `path`, or with the number of the pose before its extension if there are several
/// poses.
std::string picture_name(const std::string& path, std::size_t pose, std::size_t poses);

// Pictures of answers; charts of the convergence of bounds during a query, for `--chart` of distance, sweep
// and clash.

/// Returns the chart of lower and upper bounds against work. `what`: name of the number; `work`: unit of the
/// work.
report::Gnuplot bounds_chart(const std::vector<Bounds>& history, const std::string& what,
                             const std::string& work);
/// Returns the chart of t0 and t1, and of the distance at t0, against work.
report::Gnuplot contact_chart(const std::vector<ContactBounds>& history);

/// Options for the pictures of a command's answers.
struct DrawOptions {
  std::string picture, chart;
  PictureOptions look;   ///< of the picture: --size and --up
  bool history = false;  ///< add the bound history to the line

  bool is_watched() const { return history || !chart.empty(); }
};
/// Returns the style of the pictures. Throws InputError for an unsupported size.
pictures::Look look_of(const DrawOptions& options);
/// Adds --draw, --size and --up. `picture`: content of the picture that --draw writes.
void add_picture_options(App& app, DrawOptions& options, const std::string& picture);
/// Adds these, --chart and, if `with_history`, --convergence.
void add_draw_options(App& app, DrawOptions& options, const std::string& picture, bool with_history = true);

// Commands that answer a question for each pose of B, a line of JSON each.

/// The options of such a command, and defaults of its functions. A command Q derives from it, and has
///   kName, kHelp, add_options(app): its own options;
///   check() or check(a): throws InputError for an invalid request;
///   ask(bodies, workspace, watched): the answer. watched: keeps the history of its bounds for the chart;
///   write(w, answer, bodies, us): writes the members of its line; us(w) writes the time at its place;
///   picture(answer, bodies, look), of an answer with has_picture(answer);
/// and optionally
///   Lines: other cases than poses, kThreads: of the workspace, 0 for all cores, load(globals): both bodies,
///   prepare(a, b, globals): called before the first question; complete(answer, bodies, workspace): called
///   after the answer to be written;
///   chart(): of the history, or nullopt; show(pose, answer): true if its line is not to be printed;
///   keep(answer): called at the end of a pose; end(): called at the end.
struct PosedQuestion : PosedFiles {
  using Lines = PoseLines;
  static constexpr unsigned kThreads = 1;
  std::uint32_t repeat = 0;
  DrawOptions draw;

  void add_files(App& app) { add_posed_files(app, *this); }
  std::array<bodies::LoadedBody, 2> load(const Globals&) const {
    return bodies::load_faces_of_two(a, b, corners);
  }
  static bool has_picture(const auto&) { return true; }
  static auto picture(const auto& answer, const auto& bodies, const pictures::Look& look) {
    return pictures::picture_of(answer, bodies, look);
  }
};

template <class Q>
int answer_each(Q& q, const Globals& globals) {
  typename Q::Lines list(q.poses);
  if constexpr (requires { q.check(); }) q.check();
  look_of(q.draw);  // throws before the bodies are loaded
  const auto both = q.load(globals);
  const LrbRep &a = both[0].rep, &b = both[1].rep;
  resolve_up(q.draw.look.camera.up, a, globals);
  const pictures::Look look = look_of(q.draw);
  if constexpr (requires { q.check(a); }) q.check(a);
  for (const bodies::LoadedBody& body : both) note(globals, body.notes);
  list.check(a, b);
  if constexpr (requires { q.prepare(a, b, globals); }) q.prepare(a, b, globals);
  Workspace workspace(Q::kThreads);
  Progress progress(Q::kName, list.size(), globals.quiet);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto bodies = list.bodies(i, a, b);
    auto answer =
        list.at(i, [&]() -> decltype(auto) { return q.ask(bodies, workspace, q.draw.is_watched()); });
    if constexpr (requires { q.complete(answer, bodies, workspace); }) q.complete(answer, bodies, workspace);
    const auto us = [&](trace::JsonWriter& w) {
      if (q.repeat > 0) w.member("us", median_us(q.repeat, [&] { q.ask(bodies, workspace, false); }));
    };
    bool is_shown = false;
    if constexpr (requires { q.show(i, answer); }) is_shown = q.show(i, answer);
    if (!is_shown)
      print(trace::json_text(trace::JsonWriter::kCompact, [&](trace::JsonWriter& w) {
        w.begin_object().member(Q::Lines::kName, std::uint64_t{i});
        q.write(w, answer, bodies, us);
        w.end_object();
      }));
    const auto file = [&](const std::string& name) { return picture_name(name, i, list.size()); };
    if (!q.draw.picture.empty() && q.has_picture(answer))
      pictures::write_picture(q.picture(answer, bodies, look), file(q.draw.picture));
    if constexpr (requires { q.chart(); })
      if (!q.draw.chart.empty())
        if (const auto chart = q.chart()) report::draw(*chart, file(q.draw.chart));
    if constexpr (requires { q.keep(answer); }) q.keep(answer);
    progress.set(i + 1);
  }
  if constexpr (requires { q.end(); }) q.end();
  return kOk;
}

template <class Q>
Command add_question(App& root, const Globals& globals) {
  App* app = root.add_subcommand(Q::kName, Q::kHelp);
  const auto q = std::make_shared<Q>();
  q->add_files(*app);
  q->add_options(*app);
  add_repeat_option(*app, q->repeat, Q::Lines::kName);
  add_join_option(*app, q->corners);
  return {app, [q, &globals] { return answer_each(*q, globals); }};
}

}  // namespace lrb::tools
