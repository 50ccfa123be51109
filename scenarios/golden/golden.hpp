#pragma once
/// Reads and writes goldens: what has been approved of a scenario's run, or of a capture. A folder of goldens
/// has a folder for each of these, with
///
///   golden.json            which scenario, drawn how, compared how
///   trace.json.gz          the run, on the event clock
///   a.ply, b.ply           the bodies' meshes, if they came from files (2D: .obj)
///   frame_1.png ...        its pictures
///   frame_1.VARIANT.png    further pictures that are right as well, of other processors or drivers

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenarios/spec/scenario.hpp"
#include <lrbscope/enum_names.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::golden {

/// Parts of a run that are compared with the approved one.
enum class Level : std::uint8_t {
  answers,   ///< for each step: relation, pairs, overlap of interiors, and proofs of an approximate query
  events,    ///< bodies, request, poses, every event and every counter
  pictures,  ///< frames, within a tolerance
  work,      ///< the sum of each counter over all steps: it may decrease, or increase within a tolerance
};
constexpr auto enum_names(Level) {
  return std::to_array<EnumName<Level>>({{Level::answers, "answers"},
                                         {Level::events, "events"},
                                         {Level::pictures, "pictures"},
                                         {Level::work, "work"}});
}
inline constexpr int kLevels = 4;

/// Files with this ending are captures.
inline constexpr std::string_view kCaptureEnding = ".lrbcap";

/// The contents of golden.json.
struct GoldenSpec {
  /// Name of a shipped one, or a file, also a capture, relative to the golden's folder.
  std::string scenario;
  int width = 0, height = 0;
  std::uint32_t frames = 3;  ///< maximum number of pictures, evenly chosen from the scenario's frames
  /// (kLevels) the levels that are compared
  std::array<bool, kLevels> levels = {true, true, true, true};
  render::ImageTolerance tolerance;  ///< of pictures
  double work = 0.05;                ///< the share by which a sum of counters may increase
  /// Rectangles of pictures, in pixels: those whose contents are ignored, and those that alone are compared
  /// (empty: the whole picture).
  std::vector<render::PixelRect> ignore, only;

  bool is_capture() const { return scenario.ends_with(kCaptureEnding); }
  bool compares(Level level) const { return levels[static_cast<std::size_t>(level)]; }
  friend bool operator==(const GoldenSpec&, const GoldenSpec&) = default;
};

/// Facts of the run recorded in golden.json but not in the trace, to explain later differences.
struct GoldenFacts {
  std::vector<std::uint64_t> meshes;  ///< (bodies) mesh_hash(); empty: not recorded
  /// (steps) the length of contact, in the scenario's unit; empty: not requested, or not recorded
  std::vector<double> contact_lengths;
  std::string scenario;  ///< its JSON, without white space; empty: not recorded
  std::string renderer;  ///< versions of OpenGL, Mesa and LLVM that drew the pictures; empty: not recorded

  friend bool operator==(const GoldenFacts&, const GoldenFacts&) = default;
};

/// An approved picture.
struct GoldenImage {
  std::string file;  ///< without its folder
  render::DecodedPng png;
  std::string damage;  ///< why it cannot be read, in which case `png` is empty
};

/// A capture of another engine, which is read when its golden is tested. Its golden has the file's name.
struct CapturedQueries {
  std::string name, file;
  pictures::FrameSpec frames;
};

/// The file that a golden belongs to.
using Source = std::variant<spec::Scenario, CapturedQueries>;

/// Opens a scenario, a shipped one by name, or a file; or a capture. Throws InputError.
Source open_source(const std::string& name_or_path);
const std::string& name_of(const Source& source);
const pictures::FrameSpec& frames_of(const Source& source);

struct Golden {
  std::string name;  ///< name of the scenario and of its folder
  GoldenSpec spec;
  GoldenFacts facts;
  trace::Trace trace;
  std::vector<std::optional<Mesh>> meshes;       ///< of the bodies; nullopt if not kept
  std::vector<std::vector<GoldenImage>> frames;  ///< the variants of each frame; the unnamed one first
};

/// Returns the names of the goldens in a folder, sorted. Throws InputError if the folder has no golden.
std::vector<std::string> golden_names(const std::string& goldens);

bool has_golden(const std::string& goldens, const std::string& name);
/// Throws InputError if golden.json is missing or damaged.
GoldenSpec read_golden_spec(const std::string& goldens, const std::string& name);
/// Reads a golden. Throws InputError if a part of it is missing or damaged. Damaged pictures are kept with
/// the reason.
Golden load_golden(const std::string& goldens, const std::string& name);
/// Removes a golden: the files that approving wrote, and its folder unless other files are in it. Throws
/// InputError for a golden that does not exist.
void remove_golden(const std::string& goldens, const std::string& name);
/// Returns the scenario or the capture of a golden.
Source golden_source(const std::string& goldens, const std::string& name, const GoldenSpec& spec);

/// Returns the JSON text of the scenario of a golden; of a capture an empty text.
std::string scenario_text(const std::string& goldens, const std::string& name, const GoldenSpec& spec);

/// Returns the reference in golden.json to the scenario `name`, opened as `name_or_path`.
std::string scenario_reference(const std::string& goldens, const std::string& name,
                               const std::string& name_or_path);
void write_golden_spec(const std::string& goldens, const std::string& name, const GoldenSpec& spec,
                       const GoldenFacts& facts);

/// Returns "frame_2.png", or "frame_2.avx512.png". `frame` counts from 0, names from 1.
std::string golden_image_file(std::size_t frame, const std::string& variant = {});
/// Returns the picture files of one frame.
std::vector<std::string> image_files_of(const std::string& folder, std::size_t frame);
/// Returns the picture files of this frame and all later ones, which a shorter run no longer has.
std::vector<std::string> image_files_from(const std::string& folder, std::size_t first_frame);

inline const char* const kGoldenSpec = "golden.json";
inline const char* const kGoldenTrace = "trace.json.gz";

// Keeps the mesh of an approved body beside its golden, so that a later report can name the vertices that
// moved, and their displacement.

/// Returns a hash of all fields but the name.
std::uint64_t mesh_hash(const Mesh& mesh);

/// Returns the file name, in the golden's folder, of the kept mesh of a body, A (0) or B (1): a.ply or b.ply;
/// a.obj or b.obj for a 2D body.
std::string kept_file(std::size_t body, int dim);

/// Names the keys in which two scenarios, as JSON, differ: "frames.views[0].from: [1,0,0] -> [0,1,0]"; at
/// most three. Returns an empty text if they have equal values.
std::string scenario_difference(const std::string& expected, const std::string& found);
/// Returns a JSON text without white space and comments.
std::string compact_json(const std::string& text);

/// Describes in one line how two meshes differ: moved vertices, starting with the largest displacement; or
/// other numbers of vertices and faces. Returns an empty text if they are equal. `farthest`: where the number
/// of the vertex with the largest displacement is stored, if one moved.
std::string mesh_difference(const Mesh& expected, const Mesh& found,
                            std::optional<std::size_t>* farthest = nullptr);

}  // namespace lrb::golden
