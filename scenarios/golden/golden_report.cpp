#include "scenarios/golden/golden_report.hpp"

#include <filesystem>

#include "engine/core/atomic_file.hpp"
#include "render/image_diff.hpp"
#include "render/overlay.hpp"
#include "scenarios/golden/divergence_picture.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/page/inline_image.hpp"
#include "trace/trace_json.hpp"

namespace lrb::golden {
namespace fs = std::filesystem;
namespace {

constexpr const char* kKinds[] = {"expected", "actual", "difference"};
constexpr const char* kTitle = "Golden images and traces";
constexpr const char* kActualTrace = "actual.trace.json.gz";
constexpr const char* kDivergence = "divergence";

report::PngBytes png_of(const render::Image& image) {
  return image.empty() ? report::PngBytes() : render::encode_png(image);
}

void add_comparison(GoldenResult& result, report::PageComparison comparison, const render::Image& expected,
                    const render::Image& actual) {
  const render::Image difference =
      expected.empty() || actual.empty() ? render::Image() : render::difference_image(expected, actual);
  result.pngs.push_back({png_of(expected), png_of(actual), png_of(difference)});
  result.comparisons.push_back(std::move(comparison));
}

void add_divergence(GoldenResult& result, const Golden& golden, const GoldenRun& run) {
  const DivergencePictures pictures = draw_divergence(golden, run, *result.verdict.divergence);
  report::PageComparison c;
  c.id = result.name + "-" + kDivergence;
  c.title = result.name + ": where the runs part";
  c.text = result.verdict.divergence->message();
  if (!result.verdict.diagnosis.empty()) c.text += ". " + result.verdict.diagnosis;
  c.text += (pictures.note.empty() ? "" : ". " + pictures.note);
  c.captions = {pictures.expected_caption, pictures.actual_caption};
  c.command = result.approve;
  add_comparison(result, std::move(c), pictures.expected, pictures.actual);
}

void add_image(GoldenResult& result, const Golden& golden, const GoldenRun& run, const ImageVerdict& v) {
  report::PageComparison c;
  const std::string frame = fs::path(golden_image_file(v.frame)).stem().string();
  c.id = result.name + "-" + frame;
  c.title = result.name + ": " + v.file;
  c.text = v.text;
  c.passed = v.passed;
  if (!v.passed) c.command = result.approve;
  add_comparison(result, std::move(c),
                 v.has_expected ? golden.frames[v.frame][v.variant].png.image : render::Image(),
                 v.has_actual ? run.frames[v.frame].image : render::Image());
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return render::group_digits(n) + " " + (n == 1 ? one : many);
}

/// Returns "3 of 3 equal", "2 of 3 differ".
std::string images_words(const GoldenVerdict& verdict) {
  if (!verdict.refusal.empty()) return "not tested";
  std::size_t failed = 0, near = 0;
  for (const ImageVerdict& v : verdict.images) {
    failed += v.passed ? 0 : 1;
    near += v.passed && !v.equal ? 1 : 0;
  }
  const std::string of = std::to_string(verdict.images.size());
  if (failed > 0) return std::to_string(failed) + " of " + of + " differ";
  return of + " equal" + (near > 0 ? ", " + std::to_string(near) + " of them within tolerance" : "");
}

std::string file_of(const std::string& id, const std::string& name, const char* kind) {
  return name + "/" + id.substr(name.size() + 1) + "." + kind + ".png";
}

bool is_result(const std::string& file) {
  if (file == kActualTrace) return true;
  for (const char* kind : kKinds)
    if (file.ends_with("." + std::string(kind) + ".png")) return true;
  return false;
}

}  // namespace

GoldenResult untested_golden(const std::string& name, const std::string& refusal,
                             const std::string& approve) {
  GoldenResult result;
  result.name = name;
  result.verdict.refusal = refusal;
  result.approve = approve;
  return result;
}

GoldenResult test_golden(const Golden& golden, const GoldenRun& run, const std::string& approve, bool all) {
  GoldenResult result;
  result.name = golden.name;
  result.purpose = run.scenario.purpose;
  result.verdict = check_golden(golden, run);
  result.steps = run.recording.trace.steps.size();
  result.events = run.recording.trace.events.size();
  result.approve = approve;
  if (result.verdict.divergence) add_divergence(result, golden, run);
  for (const ImageVerdict& v : result.verdict.images)
    if (all || !v.passed) add_image(result, golden, run, v);
  return result;
}

void clear_golden_report(const std::string& folder, const std::vector<std::string>& names) {
  std::error_code error;
  const std::string page = folder + "/index.html";
  if (fs::is_regular_file(page, error) &&
      io::read_text(page).find("<title>" + std::string(kTitle)) != std::string::npos)
    fs::remove(page, error);
  for (const std::string& name : names) {
    const fs::path results = fs::path(folder) / name;
    for (const auto& file : fs::directory_iterator(results, error))
      if (is_result(file.path().filename().string())) fs::remove(file.path(), error);
    if (fs::is_empty(results, error) && !error) fs::remove(results, error);
  }
}

void write_failures(const GoldenResult& result, const GoldenRun& run, const std::string& folder) {
  if (result.verdict.passed()) return;
  io::make_folder(folder + "/" + result.name);
  if (result.verdict.divergence)
    trace::save_trace(run.recording.trace, folder + "/" + result.name + "/" + kActualTrace);
  for (std::size_t i = 0; i < result.comparisons.size(); ++i) {
    if (result.comparisons[i].passed) continue;
    for (std::size_t kind = 0; kind < std::size(kKinds); ++kind) {
      const report::PngBytes& png = result.pngs[i][kind];
      if (png.empty()) continue;
      write_file(folder + "/" + file_of(result.comparisons[i].id, result.name, kKinds[kind]),
                 {reinterpret_cast<const char*>(png.data()), png.size()});
    }
  }
}

void write_golden_page(const std::vector<GoldenResult>& results, const std::string& folder,
                       const std::string& command) {
  report::Page page;
  page.title = kTitle;
  page.command = command;
  std::size_t failed = 0, images = 0, images_failed = 0, events = 0;
  report::PageTable table;
  table.title = "Scenarios";
  table.columns = {"scenario", "verdict", "events and counters", "images"};
  std::vector<report::PngBytes> pngs;
  for (const GoldenResult& r : results) {
    const GoldenVerdict& v = r.verdict;
    failed += v.passed() ? 0 : 1;
    images += v.images.size();
    for (const ImageVerdict& image : v.images) images_failed += image.passed ? 0 : 1;
    events += r.events;
    table.rows.push_back({r.name, v.passed() ? "passed" : "FAILED",
                          !v.refusal.empty() ? v.refusal
                          : v.divergence     ? v.divergence->message()
                                             : counted(r.steps, "step", "steps") + ", " +
                                               counted(r.events, "event", "events") + ": equal",
                          images_words(v)});
    for (const auto& three : r.pngs)
      for (const report::PngBytes& png : three)
        if (!png.empty()) pngs.push_back(png);
  }
  page.verdict = failed == 0 ? "passed" : counted(failed, "failure", "failures");
  page.purpose =
      "Runs against what was approved of them: events and counters must be equal; pictures may differ by "
      "what "
      "processors differ by.";
  page.numbers = {{"scenarios", std::to_string(results.size()), std::to_string(failed) + " failed"},
                  {"events compared", render::group_digits(events), "each field, exactly"},
                  {"images", std::to_string(images), std::to_string(images_failed) + " failed"}};
  page.tables = {std::move(table)};
  const report::InlinedImages inlined = report::inline_pngs(pngs);
  std::size_t next = 0;
  for (const GoldenResult& r : results) {
    for (std::size_t i = 0; i < r.comparisons.size(); ++i) {
      report::PageComparison c = r.comparisons[i];
      for (std::size_t kind = 0; kind < std::size(kKinds); ++kind)
        if (!r.pngs[i][kind].empty()) c.data_uris[kind] = inlined.uris[next++];
      page.comparisons.push_back(std::move(c));
    }
  }
  page.footer = inlined.note;
  io::write_text(folder + "/index.html", report::page_html(page));
}

std::string result_text(const GoldenResult& r) {
  const GoldenVerdict& v = r.verdict;
  if (!v.refusal.empty())
    return "FAIL  " + r.name + ": " + v.refusal + "\n      approve it once that is mended: " + r.approve +
           "\n";
  std::string out =
      (v.passed() ? "ok    " : "FAIL  ") + r.name + ": " +
      (v.divergence ? "events or counters differ" : counted(r.events, "event", "events") + " equal") +
      "; images: " + images_words(v) + "\n";
  if (v.divergence) out += "      " + v.divergence->message() + "\n";
  if (!v.diagnosis.empty()) out += "      " + v.diagnosis + "\n";
  for (const ImageVerdict& image : v.images)
    if (!image.passed) out += "      " + image.file + ": " + image.text + "\n";
  if (!v.passed() && v.scenario_changed)
    out += "      the scenario's file is not the one that was approved\n";
  if (!v.passed()) out += "      approve it: " + r.approve + "\n";
  return out;
}

}  // namespace lrb::golden
