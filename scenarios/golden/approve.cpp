#include "scenarios/golden/approve.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "scenarios/golden/check.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/trace/divergence.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::golden {

namespace fs = std::filesystem;
namespace {

/// Changes the files of one golden's folder, and records what it changed. `dry`: only records it.
class Approval {
 public:
  Approval(const std::string& folder, bool dry) : folder_(folder), dry_(dry) {
    if (dry_) return;
    make_folder(folder_.string());
    lock_.emplace(folder_.string());
  }

  /// Writes a file with `write(path)`.
  template <class Write>
  void approve(const std::string& file, const Write& write) {
    if (!dry_) write((folder_ / file).string());
    // A removed file that is written again was replaced.
    note(std::erase(done, line("removed", file)) > 0 ? "replaced" : "approved", file);
  }
  void remove(const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      std::error_code error;
      if (!dry_) fs::remove(folder_ / file, error);
      note("removed", file);
    }
  }
  std::vector<std::string> done;

 private:
  std::string line(const std::string& what, const std::string& file) const {
    return (dry_ ? "would be " : "") + what + " " + (folder_ / file).generic_string();
  }
  void note(const std::string& what, const std::string& file) { done.push_back(line(what, file)); }

  fs::path folder_;
  bool dry_;
  std::optional<io::FolderLock> lock_;
};

/// Loads a golden; nullopt if it does not exist, or its files are missing or damaged: approving replaces
/// them.
std::optional<Golden> load_if_sound(const std::string& goldens, const std::string& name) {
  try {
    if (has_golden(goldens, name)) return load_golden(goldens, name);
  } catch (const InputError&) {
  }
  return std::nullopt;
}

/// Approves a golden that lies in another folder of goldens.
std::vector<std::string> approve_files(const std::string& goldens, const Golden& found,
                                       const std::string& found_in, bool dry) {
  const std::string folder = (fs::path(goldens) / found.name).string(),
                    from = (fs::path(found_in) / found.name).string();
  Approval approval(folder, dry);
  const auto copy = [&](const std::string& file) {
    if (fs::exists(from + "/" + file))
      approval.approve(file,
                       [&](const std::string& to) { write_file(to, io::read_text(from + "/" + file)); });
  };
  const std::optional<Golden> old = load_if_sound(goldens, found.name);
  if (!old) approval.remove(image_files_from(folder, 0));
  if (!old || trace::first_divergence(old->trace, found.trace)) copy(kGoldenTrace);
  if (!old || old->facts.meshes != found.facts.meshes)
    for (const int dim : {2, 3})
      for (const std::size_t body : {0, 1}) copy(kept_file(body, dim));
  static const std::vector<GoldenImage> none;
  bool same_pictures = true;
  for (std::size_t i = 0; i < std::max(old ? old->frames.size() : 0, found.frames.size()); ++i) {
    const bool has_new = i < found.frames.size() && !found.frames[i].empty();
    if (old && has_new) {
      frames::PaintedFrame picture;
      picture.image = found.frames[i][0].png.image;
      if (check_frame(i < old->frames.size() ? old->frames[i] : none, picture, i, found.spec).passed)
        continue;
    }
    same_pictures = false;
    if (old) approval.remove(image_files_of(folder, i));
    if (has_new) copy(golden_image_file(i));
  }
  GoldenFacts facts = found.facts;
  if (old && same_pictures && !old->facts.renderer.empty()) facts.renderer = old->facts.renderer;
  if (!old || old->spec != found.spec || old->facts != facts)
    approval.approve(kGoldenSpec,
                     [&](const std::string&) { write_golden_spec(goldens, found.name, found.spec, facts); });
  return std::move(approval.done);
}

void write_frame(const GoldenRun& run, std::size_t frame, const std::string& path) {
  render::PngOptions png;
  png.text = golden_text(run, frame);
  render::write_png(run.frames[frame].image, path, png);
}

}  // namespace

void write_golden(const std::string& goldens, const GoldenSpec& spec, const GoldenRun& run) {
  const std::string folder = (fs::path(goldens) / run.scenario.name).string();
  make_folder(folder);
  for (const std::string& file : image_files_from(folder, 0)) fs::remove(fs::path(folder) / file);
  write_golden_spec(goldens, run.scenario.name, spec, facts_of(run));
  trace::save_trace(run.recording.trace, folder + "/" + kGoldenTrace);
  for (std::size_t i = 0; i < run.recording.bodies.size(); ++i) {
    if (run.scenario.bodies[i].file.empty()) continue;  // generated bodies are defined by their scenario
    const LrbRep& rep = run.recording.bodies[i].rep;
    write_mesh(rep.real_mesh(), folder + "/" + kept_file(i, rep.dim()));
  }
  for (std::size_t i = 0; i < run.frames.size(); ++i)
    write_frame(run, i, folder + "/" + golden_image_file(i));
}

std::vector<std::string> approve_golden(const std::string& goldens, const GoldenSpec& spec,
                                        const GoldenRun& run, bool dry) {
  const io::TemporaryFolder temporary;
  const std::string folder = temporary.path.string();
  write_golden(folder, spec, run);
  return approve_files(goldens, load_golden(folder, run.scenario.name), folder, dry);
}

std::vector<std::string> approve_variant(const std::string& goldens, const GoldenRun& run,
                                         const std::string& variant, bool dry) {
  const std::string& name = run.scenario.name;
  const bool plain = variant.size() <= 64 && std::all_of(variant.begin(), variant.end(), [](char c) {
                       return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                              c == '_' || c == '-';
                     });
  if (!plain) throw InputError("--variant: expected 1 to 64 letters, digits, - and _");
  if (!has_golden(goldens, name))
    throw InputError(name + ": has no golden yet; approve it first, without --variant");
  Approval approval((fs::path(goldens) / name).string(), dry);
  const GoldenVerdict verdict = check_golden(load_golden(goldens, name), run);
  if (verdict.divergence)
    throw InputError(name + ": " + verdict.divergence->message() +
                     "; events must match on all machines, so approve them first, without --variant");
  for (const ImageVerdict& image : verdict.images) {
    if (image.passed) continue;
    if (!image.has_actual || !image.has_expected)
      throw InputError(name + ": " + image.file + ": " + image.text +
                       "; approve it first, without --variant");
    approval.approve(golden_image_file(image.frame, variant),
                     [&](const std::string& path) { write_frame(run, image.frame, path); });
  }
  return std::move(approval.done);
}

std::vector<std::string> approve_from(const std::string& goldens, const std::string& from,
                                      const std::vector<std::string>& names, bool dry) {
  if (fs::is_regular_file(from))
    throw InputError(printable_name(from) +
                     ": expected the output folder of lrbscope golden test; unpack an archive first");
  const std::string folder = (fs::path(from) / kApprovable).string();
  std::error_code error;
  if (fs::is_empty(folder, error) || error)
    throw InputError(printable_name(from) +
                     ": has no failures of goldens; expected the output folder of lrbscope golden test");
  for (const std::string& name : names)
    if (!has_golden(folder, name))
      throw InputError(printable_name(from) + ": has no failure of a golden " + printable_name(name));
  // All of them must be sound before the first one is approved.
  std::vector<Golden> all;
  try {
    for (const std::string& name : names.empty() ? golden_names(folder) : names) {
      all.push_back(load_golden(folder, name));
      for (const auto& variants : all.back().frames)
        for (const GoldenImage& image : variants)
          if (!image.damage.empty()) throw InputError(image.damage);
    }
  } catch (const InputError& e) {
    throw InputError(std::string(e.what()) + "; nothing was approved");
  }
  std::vector<std::string> done;
  for (const Golden& found : all) {
    const std::vector<std::string> lines = approve_files(goldens, found, folder, dry);
    done.insert(done.end(), lines.begin(), lines.end());
    if (lines.empty()) done.push_back("unchanged " + found.name);
  }
  return done;
}

}  // namespace lrb::golden
