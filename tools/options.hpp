#pragma once
/// Options shared by several commands.

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/camera.hpp>
#include <lrbscope/trace/event.hpp>

namespace lrb::tools {

/// Returns the named elements of `all` in their order, or all if none is named. Throws InputError for an
/// unknown name.
template <class T, class NameOf>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::string>& names, const char* what,
                      const NameOf& name_of) {
  if (names.empty()) return all;
  std::vector<std::string> known;
  std::transform(all.begin(), all.end(), std::back_inserter(known), name_of);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string list;
    for (const std::string& k : known) list.append(list.empty() ? "" : ", ").append(k);
    throw InputError(std::string("unknown ") + what + " '" + name + "'; known: " + list);
  }
  std::vector<T> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out),
               [&](const T& t) { return std::find(names.begin(), names.end(), name_of(t)) != names.end(); });
  return out;
}

/// Adds an option whose value is the name of an enumerator.
template <class Enum, class Target>
void add_choice(App& app, const std::string& name, Target& target, const std::string& what) {
  std::vector<std::string> words;
  words.reserve(kEnumNames<Enum>.size());
  for (const EnumName<Enum>& entry : kEnumNames<Enum>) words.emplace_back(entry.name);
  app.add_option_function<std::string>(
         name, [&target](const std::string& word) { target = from_name<Enum>(word).value(); },
         all_names<Enum>("|", "|"), what)
      ->one_of(words);
}

/// Adds --tex.
void add_tex_option(App& app, bool& tex, const char* what);
/// Adds --mode, --recursion, --predicates and --max-pairs.
void add_request_options(App& app, CollideRequest& request);
/// Adds --tolerance, --max-tests and --max-time.
void add_coarse_options(App& app, CollideRequest& request);
/// Adds --recursion, which overrides the scenario.
void add_recursion_option(App& app, std::optional<Recursion>& recursion);
/// Adds --events, which overrides the scenario.
void add_events_option(App& app, std::optional<EventLevel>& level);
/// Adds --clock, which overrides the scenario.
void add_clock_option(App& app, std::optional<trace::Clock>& clock);
/// Adds --no-join.
void add_join_option(App& app, bodies::Corners& corners);
/// Adds --repeat. what: the unit of a query, such as "pose".
void add_repeat_option(App& app, std::uint32_t& repeat, const std::string& what);
/// Adds --patch, --max-outer, --max-lids, --merge-planes, --lean, --seed and --threads.
void add_build_options(App& app, BuildOptions& options);

/// Camera options of pictures: --from, --look-at, --zoom, --projection and --up, and --orbit if added. They
/// override the scenario.
struct CameraOptions {
  std::string from, look_at, up;
  std::optional<double> orbit;
  std::optional<double> zoom;
  std::optional<bool> orthographic;
};
/// `auto_up`: the default of --up is auto, else z.
void add_camera_options(App& app, CameraOptions& options, bool auto_up = false);
/// Adds --orbit, for pictures of several frame states.
void add_orbit_option(App& app, CameraOptions& options);
/// Applies the options to all views. --up rotates existing views, unless it is still auto (resolve_up());
/// --from and --look-at are given in the axes of the bodies' files, and are not rotated. Throws InputError
/// for an invalid camera.
void apply(const CameraOptions& options, std::vector<pictures::FrameSpec::View>& views);

/// The camera options, and --size, --dpi, --style, --no-title, --no-legend, --transparent, --format,
/// --frames, --every, --most, --colour-by, --colour-per and --node-boxes, which override the scenario.
struct PictureOptions {
  CameraOptions camera;
  std::string size, animation;
  std::optional<double> dpi;
  std::optional<bool> svg;
  bool transparent = false;
  std::optional<render::StyleName> style;
  bool titles = true, legend = true;
  std::optional<pictures::FrameSpec::At> at;
  std::optional<std::uint32_t> every, most, view;
  std::optional<pictures::FrameSpec::ColourBy> colour_by;
  std::optional<pictures::FrameSpec::ColourPer> colour_per;
  std::optional<std::uint32_t> node_boxes;
};
void add_picture_options(App& app, PictureOptions& options, bool auto_up = false);
/// Adds --size, --dpi and --style alone.
void add_size_options(App& app, PictureOptions& options);
/// Adds --style alone; `usual` is its default.
void add_style_option(App& app, PictureOptions& options, const std::string& usual);
/// Adds --colour-by and --node-boxes alone.
void add_colour_options(App& app, PictureOptions& options);
void apply(const PictureOptions& options, pictures::FrameSpec& spec);
/// Throws InputError if --view is none of the `views` views.
void check_view(const PictureOptions& options, std::size_t views);

/// Adds --view and --animate, for commands that call animate_frames().
void add_animation_option(App& app, PictureOptions& options);
/// Encodes the frames in a folder as an animation, if one was requested.
void animate_frames(const PictureOptions& options, const std::string& folder);

/// Adds --up, of all commands that draw.
void add_up_option(App& app, std::string& up, bool auto_up = false);
/// Replaces --up auto by the axis on which the body is most stable, or z, and notes it. Of a 2D body, by
/// nothing.
void resolve_up(std::string& up, const LrbRep& rep, const Globals& globals);
/// Returns the default view, rotated by a resolved --up.
render::ViewDirection view_with(const std::string& up);
/// Returns a view rotated so that an axis (0, 1, 2) points up instead of z.
render::ViewDirection turned_up(const render::ViewDirection& view, int axis);

/// Selects the view direction across the line from A to B from which the bodies hide least of the contacts,
/// unless one was given. Omits a close-up that would show almost the entire scene.
void choose_views(const CameraOptions& given, spec::Scenario& scenario, record::Recording& recording);

/// The run of two meshes: B at poses, or moved towards A past the first contact.
struct TwoMeshes {
  bodies::Corners corners = bodies::Corners::joined;
  std::string a, b, poses, steps, approach;
  bool gzip = false;  ///< of the trace
  CollideRequest request;
  spec::StepQuestions more;
  std::optional<EventLevel> events;
  std::optional<trace::Clock> clock;
};
/// Adds --poses and --approach.
void add_motion_options(App& app, TwoMeshes& meshes);
/// Reads the poses and the meshes, chooses the axis that points up and the views, and records the run.
std::pair<spec::Scenario, record::Recording> record_meshes(const TwoMeshes& meshes,
                                                           const PictureOptions& given,
                                                           const Globals& globals);

/// Returns the number of hardware threads, at least 1.
std::uint32_t all_cores();

/// Prints the outcome of a run and returns its exit code.
int report_outcome(const run::RunOutcome& outcome, const std::string& folder, bool json,
                   const Globals& globals);

}  // namespace lrb::tools
