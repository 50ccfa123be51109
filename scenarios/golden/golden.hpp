#pragma once
/// Reads and writes goldens: what has been approved of a scenario's run. A folder of goldens has a folder for
/// each scenario, with
///
///   golden.json            which scenario, drawn how
///   trace.json.gz          the run, on the event clock
///   frame_1.png ...        its pictures
///   frame_1.VARIANT.png    further pictures that are right as well, of other processors or drivers

#include <string>
#include <vector>

#include "render/png.hpp"
#include "scenarios/spec/scenario.hpp"
#include "trace/trace.hpp"

namespace lrb::golden {

/// What golden.json says.
struct GoldenSpec {
  std::string scenario;  ///< name of a shipped one, or a file, looked up from the golden's own folder
  int width = 0, height = 0;
  std::uint32_t frames = 3;  ///< largest number of pictures, evenly chosen from the scenario's frames
};

/// A picture that was approved.
struct GoldenImage {
  std::string file;  ///< without its folder
  render::DecodedPng png;
  std::string damage;  ///< why it cannot be read; then `png` is empty
};

struct Golden {
  std::string name;  ///< of the scenario, and of its folder
  GoldenSpec spec;
  trace::Trace trace;
  std::vector<std::vector<GoldenImage>> frames;  ///< the variants of each frame; the one without a name first
};

/// Returns the names of the goldens in a folder, sorted. Throws InputError if there is none.
std::vector<std::string> golden_names(const std::string& goldens);

bool has_golden(const std::string& goldens, const std::string& name);
/// Throws InputError if golden.json is missing or damaged.
GoldenSpec read_golden_spec(const std::string& goldens, const std::string& name);
/// Reads a golden; throws InputError if a part of it is missing or damaged. Damaged pictures are kept and say
/// what is wrong.
Golden load_golden(const std::string& goldens, const std::string& name);
/// Returns the scenario that a golden is of.
spec::Scenario golden_scenario(const std::string& goldens, const std::string& name, const GoldenSpec& spec);

/// Returns what golden.json says about a scenario opened as `name_or_path`.
std::string scenario_reference(const std::string& goldens, const spec::Scenario& scenario,
                               const std::string& name_or_path);
void write_golden_spec(const std::string& goldens, const std::string& name, const GoldenSpec& spec);

/// Returns "frame_2.png", or "frame_2.avx512.png". Frames count from 0 here, from 1 in names.
std::string golden_image_file(std::size_t frame, const std::string& variant = {});
/// Returns the files of pictures of one frame.
std::vector<std::string> image_files_of(const std::string& folder, std::size_t frame);
/// Returns the files of pictures of this frame and all later ones, which a shorter run no longer has.
std::vector<std::string> image_files_from(const std::string& folder, std::size_t first_frame);

inline const char* const kGoldenTrace = "trace.json.gz";

}  // namespace lrb::golden
