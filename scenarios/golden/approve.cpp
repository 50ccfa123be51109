#include "scenarios/golden/approve.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "engine/core/atomic_file.hpp"
#include "engine/core/error.hpp"
#include "engine/mesh/io/mesh_io.hpp"
#include "scenarios/golden/check.hpp"
#include "scenarios/golden/kept_body.hpp"
#include "scenarios/io/files.hpp"
#include "trace/trace_json.hpp"

namespace lrb::golden {
namespace fs = std::filesystem;
namespace {

void check_variant(const std::string& variant) {
  const bool plain = variant.size() <= 64 && std::all_of(variant.begin(), variant.end(), [](char c) {
                       return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                              c == '_' || c == '-';
                     });
  if (!plain) throw InputError("--variant: expected 1 to 64 letters, digits, - and _");
}

/// Writes into one golden's folder, and keeps account.
class Approval {
 public:
  Approval(const std::string& folder, const GoldenRun& run) : folder_(folder), run_(run) {}

  void trace() {
    trace::save_trace(run_.recording.trace, folder_ + "/" + kGoldenTrace);
    say("approved", kGoldenTrace);
  }
  void frame(std::size_t i, const std::string& variant) {
    render::PngOptions png;
    png.text = golden_text(run_, i);
    const std::string file = golden_image_file(i, variant);
    render::write_png(run_.frames[i].image, folder_ + "/" + file, png);
    say("approved", file);
  }
  /// Keeps the meshes of bodies that came from files: those that are generated are known by their scenario.
  void meshes() {
    for (std::size_t i = 0; i < run_.recording.bodies.size(); ++i) {
      if (run_.scenario.bodies[i].file.empty()) continue;
      const LrbRep& rep = run_.recording.bodies[i].rep;
      const std::string file = kept_file(i, rep.dim());
      write_mesh(kept_mesh(rep), folder_ + "/" + file);
      say("approved", file);
    }
  }
  void remove(const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      std::error_code error;
      fs::remove(folder_ + "/" + file, error);
      say("removed", file);
    }
  }
  void say(const std::string& what, const std::string& file) {
    done.push_back(what + " " + (fs::path(folder_) / file).generic_string());
  }
  std::vector<std::string> done;

 private:
  std::string folder_;
  const GoldenRun& run_;
};

/// Calls something that reads a golden; returns nothing if files are missing or damaged and that `may_fail`,
/// because approving replaces them by sound ones.
std::optional<Golden> load_if_sound(const std::string& goldens, const std::string& name, bool may_fail) {
  try {
    return load_golden(goldens, name);
  } catch (const InputError&) {
    if (!may_fail) throw;
    return std::nullopt;
  }
}

std::vector<std::string> approve_all(Approval approval, const GoldenRun& run, const std::string& folder) {
  approval.remove(image_files_from(folder, 0));
  approval.trace();
  approval.meshes();
  for (std::size_t i = 0; i < run.frames.size(); ++i) approval.frame(i, {});
  return std::move(approval.done);
}

std::vector<std::string> approve_variant(Approval approval, const GoldenVerdict& verdict,
                                         const std::string& name, const std::string& variant) {
  if (verdict.divergence)
    throw InputError(name + ": " + verdict.divergence->message() +
                     "; events must be the same everywhere: approve them first, without --variant");
  for (const ImageVerdict& image : verdict.images) {
    if (image.passed) continue;
    if (!image.has_actual || !image.has_expected)
      throw InputError(name + ": " + image.file + ": " + image.text +
                       "; approve it first, without --variant");
    approval.frame(image.frame, variant);
  }
  return std::move(approval.done);
}

}  // namespace

std::vector<std::string> approve_golden(const std::string& goldens, const GoldenSpec& spec,
                                        const GoldenRun& run, const std::string& variant) {
  const std::string name = run.scenario.name, folder = (fs::path(goldens) / name).string();
  check_variant(variant);
  const bool known = has_golden(goldens, name);
  if (!known && !variant.empty())
    throw InputError(name + ": has no golden yet; approve it first, without --variant");
  make_folder(folder);
  const io::FolderLock lock(folder);
  const GoldenFacts facts = facts_of(run);
  const std::optional<Golden> old = known ? load_if_sound(goldens, name, variant.empty()) : std::nullopt;
  if (!old) {
    write_golden_spec(goldens, name, spec, facts);
    return approve_all({folder, run}, run, folder);
  }
  Golden golden = *old;
  if (variant.empty()) golden.spec.levels = GoldenSpec{}.levels;  // all that differs is approved
  const GoldenVerdict verdict = check_golden(golden, run);
  if (!variant.empty()) return approve_variant({folder, run}, verdict, name, variant);
  Approval approval(folder, run);
  if (old->spec != spec || old->facts != facts) {
    write_golden_spec(goldens, name, spec, facts);
    approval.say("approved", kGoldenSpec);
  }
  if (verdict.divergence) approval.trace();
  if (old->facts.meshes != facts.meshes) approval.meshes();
  for (const ImageVerdict& image : verdict.images) {
    if (image.passed) continue;
    approval.remove(image_files_of(folder, image.frame));
    if (image.has_actual) approval.frame(image.frame, {});
  }
  return std::move(approval.done);
}

}  // namespace lrb::golden
