#include "scenarios/golden/golden_report.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "render/canvas.hpp"
#include "render/gl.hpp"
#include "scenarios/golden/approve.hpp"
#include "scenarios/golden/golden_pictures.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::golden {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKinds[] = {"expected", "actual", "difference"};
constexpr const char* kTitle = "Golden images and traces";

/// Returns "3 of 3 equal", "2 of 3 differ".
std::string images_text(const GoldenResult& result) {
  const GoldenVerdict& verdict = result.verdict;
  if (!verdict.rejection.empty()) return "not tested";
  if (!result.spec.compares(Level::pictures)) return "not compared";
  std::size_t failed = 0, near = 0;
  for (const ImageVerdict& v : verdict.images) {
    failed += v.passed ? 0 : 1;
    near += v.passed && !v.equal ? 1 : 0;
  }
  const std::string of = std::to_string(verdict.images.size());
  if (failed > 0) return std::to_string(failed) + " of " + of + " differ";
  return of + " equal" + (near > 0 ? ", " + std::to_string(near) + " of them within tolerance" : "");
}

std::string answers_text(const GoldenResult& r) {
  if (!r.verdict.rejection.empty()) return "not tested";
  if (!r.spec.compares(Level::answers)) return "not compared";
  if (!r.verdict.answers_differ) return render::counted(r.steps, "step", "steps") + ": equal";
  std::set<std::uint32_t> steps;
  for (const Effect& e : r.verdict.effects)
    if (e.kind == Effect::Kind::answer) steps.insert(e.step);
  return "differ in " + std::to_string(steps.size()) + " of " + render::counted(r.steps, "step", "steps");
}

/// Returns "132 events equal".
std::string events_text(const GoldenResult& r) {
  if (!r.verdict.rejection.empty()) return "not tested";
  if (!r.spec.compares(Level::events)) return "not compared";
  return render::counted(r.events, "event", "events") + (r.verdict.divergence ? " differ" : " equal");
}

/// Returns why a test failed, on one line; empty if it passed.
std::string cause_text(const GoldenResult& r) {
  const GoldenVerdict& v = r.verdict;
  return v.causes.empty() ? v.rejection : v.causes.front();
}

std::string work_text(const GoldenResult& r) {
  if (!r.verdict.rejection.empty()) return "not tested";
  if (!r.spec.compares(Level::work)) return "not compared";
  std::string out;
  for (const Effect& e : r.verdict.more_work)
    out.append(out.empty() ? "" : "; ").append(e.what + " " + e.expected + " -> " + e.found);
  return out.empty() ? "within budget" : out;
}

std::string with_arrows(std::string text) {
  for (std::size_t i = 0; (i = text.find(" -> ", i)) != std::string::npos;) text.replace(i, 4, " \u2192 ");
  return text;
}

report::Table effects_table(const GoldenResult& r) {
  constexpr std::size_t kMaxRows = 200;
  report::Table t{r.name + ": answers and counters", {"step", "quantity", "approved", "found"}};
  t.folded = true;
  for (const Effect& e : r.verdict.more_work)
    t.rows.push_back({"all", e.what + " (budget exceeded)", e.expected, e.found});
  for (std::size_t i = 0; i < std::min(r.verdict.effects.size(), kMaxRows); ++i) {
    const Effect& e = r.verdict.effects[i];
    t.rows.push_back({std::to_string(e.step), e.what, e.expected, e.found});
  }
  if (r.verdict.effects.size() > kMaxRows)
    t.note = "And " + render::group_digits(r.verdict.effects.size() - kMaxRows) + " more. ";
  if (r.verdict.effects.empty()) t.rows.push_back({"all", "answers and counters", "", "as approved"});
  if (!r.renderer.empty()) t.note += "Pictures: " + r.renderer + ". ";
  return t;
}

std::string file_of(const std::string& id, const std::string& name, const char* kind) {
  return name + "/" + id.substr(name.size() + 1) + "." + kind + ".png";
}

bool is_result(const std::string& file) {
  return std::ranges::any_of(
      kKinds, [&](const char* kind) { return file.ends_with("." + std::string(kind) + ".png"); });
}

}  // namespace

GoldenResult untested_golden(const std::string& name, const std::string& rejection,
                             const std::string& approve) {
  GoldenResult result;
  result.name = name;
  result.verdict.rejection = rejection;
  result.approve = approve;
  return result;
}

GoldenResult test_golden(const Golden& golden, const GoldenRun& run, const std::string& approve, bool all) {
  GoldenResult result;
  result.name = golden.name;
  result.purpose = run.scenario.purpose;
  result.spec = golden.spec;
  result.verdict = check_golden(golden, run);
  result.steps = run.recording.trace.steps.size();
  result.events = run.recording.trace.events.size();
  result.approve = approve;
  if (result.verdict.divergence) {
    add_divergence(result, golden, run);
    try {
      add_maps(result, golden, run);
    } catch (const InputError&) {  // a level that the approved run traversed is gone
    }
  }
  for (const ImageVerdict& v : result.verdict.images)
    if (all || !v.passed) add_image(result, golden, run, v);
  if (!result.verdict.images_passed()) {
    const std::string& approved = golden.facts.renderer;
    const std::string drawn = "OpenGL " + render::gl_version();
    result.renderer = approved.empty() ? "drawn with " + drawn
                      : approved == render::gl_version()
                          ? "approved and drawn with " + drawn
                          : "approved with OpenGL " + approved + "; drawn with " + drawn;
  }
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
    if (has_golden(folder + "/" + kApprovable, name)) remove_golden(folder + "/" + kApprovable, name);
  }
  const std::string approvable = folder + "/" + kApprovable;
  if (fs::is_empty(approvable, error) && !error) fs::remove(approvable, error);
}

void write_failures(const GoldenResult& result, const GoldenRun& run, const std::string& folder) {
  if (result.verdict.passed()) return;
  make_folder(folder + "/" + result.name);
  write_golden(folder + "/" + kApprovable, result.spec, run);
  for (const report::Comparison& c : result.comparisons)
    for (std::size_t kind = 0; kind < std::size(kKinds); ++kind)
      if (const report::PngBytes& png = c.pngs[kind]; !c.passed && !png.empty())
        write_file(folder + "/" + file_of(c.id, result.name, kKinds[kind]),
                   {reinterpret_cast<const char*>(png.data()), png.size()});
}

void write_golden_page(const std::vector<GoldenResult>& results, const report::Folder& folder,
                       const std::string& command) {
  std::size_t failed = 0, images = 0, images_failed = 0, events = 0;
  report::Table scenarios{
      "Scenarios",
      {"scenario", "verdict", "cause", "answers", "events and counters", "work", "images", "seconds"}};
  for (const GoldenResult& r : results) {
    const GoldenVerdict& v = r.verdict;
    failed += v.passed() ? 0 : 1;
    images += v.images.size();
    for (const ImageVerdict& image : v.images) images_failed += image.passed ? 0 : 1;
    events += r.events;
    scenarios.rows.push_back({r.name, v.passed() ? "passed" : "FAILED", with_arrows(cause_text(r)),
                              answers_text(r), events_text(r),
                              v.more_work.size() > 1
                                  ? std::to_string(v.more_work.size()) + " counters beyond the budget"
                                  : with_arrows(work_text(r)),
                              images_text(r), io::fixed_text(r.seconds, 1)});
    scenarios.targets.push_back(!v.passed()             ? "#" + r.name
                                : r.comparisons.empty() ? std::string()
                                                        : "#" + r.comparisons.front().id);
    scenarios.pictures.push_back(r.thumbnail);
  }
  report::Document doc(kTitle, render::counted(results.size(), "scenario", "scenarios") + ", " +
                                   std::to_string(failed) + " failed. " + render::group_digits(events) +
                                   " events compared exactly. " + render::counted(images, "image", "images") +
                                   " compared within the rounding of other processors, " +
                                   std::to_string(images_failed) + " failed.");
  std::string causes;
  for (const std::string& line : equal_causes(results)) causes += (causes.empty() ? "" : " ") + line + ".";
  doc.summary(with_arrows(causes))
      .verdict(failed == 0 ? "passed" : render::counted(failed, "failure", "failures"), failed == 0)
      .command(command)
      .table(scenarios);
  // A section for each failure: its causes and the command that approves it; pictures; numbers.
  std::vector<report::Comparison> passed;
  for (const GoldenResult& r : results) {
    if (r.verdict.passed()) {
      passed.insert(passed.end(), r.comparisons.begin(), r.comparisons.end());
      continue;
    }
    std::string why = r.verdict.rejection;
    for (const std::string& cause : r.verdict.causes) why += (why.empty() ? "" : "; ") + cause;
    std::vector<report::Comparison> section = {
        {r.name, r.name, with_arrows(why), false, {}, {}, r.verdict.rejection.empty() ? r.approve : ""}};
    section.insert(section.end(), r.comparisons.begin(), r.comparisons.end());
    std::stable_partition(section.begin() + 1, section.end(), [](const report::Comparison& c) {
      return !c.pngs[0].empty() || !c.pngs[1].empty();
    });
    doc.comparisons(section);
    if (r.verdict.rejection.empty()) doc.table(effects_table(r));
  }
  doc.comparisons(passed).write(folder);
}

std::string result_text(const GoldenResult& r) {
  const GoldenVerdict& v = r.verdict;
  if (!v.rejection.empty()) return "FAIL  " + r.name + ": " + v.rejection + "\n";
  std::string head = v.answers_differ                  ? "answers " + answers_text(r)
                     : v.divergence                    ? "events or counters differ"
                     : !v.more_work.empty()            ? "more work than allowed"
                     : r.spec.compares(Level::events)  ? events_text(r)
                     : r.spec.compares(Level::answers) ? "answers of " + answers_text(r)
                     : r.spec.compares(Level::work)    ? "work " + work_text(r)
                                                       : "answers not compared";
  std::string out =
      (v.passed() ? "ok    " : "FAIL  ") + r.name + ": " + head + "; images: " + images_text(r) + "\n";
  if (v.passed()) return out;
  for (const std::string& cause : v.causes) out += "      cause: " + cause + "\n";
  if (r.repeats > 0)
    out += "      " + (r.passes > 0 ? "flaky: " + std::to_string(r.passes) + " of " +
                                          std::to_string(r.repeats) + " repeats passed\n"
                                    : "changed: none of " + std::to_string(r.repeats) + " repeats passed\n");
  for (const Effect& e : v.more_work)
    out += "      work: " + e.what + " of all steps: approved " + e.expected + ", found " + e.found +
           ", more than " + render::short_number(100 * r.spec.work) + " % more\n";
  // Differences of one quantity are one line, with the first step that has one.
  std::vector<std::pair<const Effect*, std::size_t>> kinds;
  for (const Effect& e : v.effects) {
    const auto same = std::ranges::find_if(kinds, [&](const auto& k) { return k.first->what == e.what; });
    if (same == kinds.end())
      kinds.emplace_back(&e, 1);
    else
      ++same->second;
  }
  for (const auto& [e, count] : kinds)
    out += "      step " + std::to_string(e->step) + ": " + e->what + ": expected " + e->expected +
           ", found " + e->found +
           (count == 1 ? "" : "; and in " + render::counted(count - 1, "more step", "more steps")) + "\n";
  const auto said = [&](const std::string& text) { return out.find(text) != std::string::npos; };
  if (v.divergence && !said(v.divergence->message()))
    out += "      first difference: " + v.divergence->message() + "\n";
  if (!v.diagnosis.empty() && !said(v.diagnosis)) out += "      " + v.diagnosis + "\n";
  for (const ImageVerdict& image : v.images)
    if (!image.passed) out += "      " + image.file + ": " + image.text + "\n";
  if (!r.renderer.empty()) out += "      pictures: " + r.renderer + "\n";
  if (!r.page.empty())
    for (const report::Comparison& c : r.comparisons)
      if (!c.passed) out += "      " + r.page + "#" + c.id + "\n";
  out += "      approve it: " + r.approve + "\n";
  return out;
}

namespace {

constexpr int kDecimals = 3;  // of seconds

std::string case_xml(const GoldenResult& r) {
  std::string out = "  <testcase classname=\"golden\" name=\"" + render::escape_markup(r.name) +
                    "\" time=\"" + io::fixed_text(r.seconds, kDecimals) + "\"";
  if (r.verdict.passed()) return out + "/>\n";
  const char* kind = r.verdict.rejection.empty() ? "failure" : "error";
  // The name is in the case, and the verdict in the element: the message is the rest of the first line, and
  // the element's text is the remainder.
  const std::string text = result_text(r), head = "FAIL  " + r.name + ": ";
  const std::size_t end = text.find('\n');
  return out + ">\n    <" + kind + " message=\"" +
         render::escape_markup(text.substr(head.size(), end - head.size())) + "\">" +
         render::escape_markup(text.substr(end + 1)) + "</" + kind + ">\n  </testcase>\n";
}

}  // namespace

std::vector<std::string> equal_causes(const std::vector<GoldenResult>& results) {
  std::map<std::string, std::vector<const GoldenResult*>> groups;
  for (const GoldenResult& r : results)
    if (!r.verdict.group.empty()) groups[r.verdict.group].push_back(&r);
  std::vector<std::string> out;
  for (const auto& [group, members] : groups) {
    if (members.size() < 2) continue;
    std::string names;
    for (const GoldenResult* r : members) names.append(names.empty() ? "" : ", ").append(r->name);
    out.push_back("one cause in " + std::to_string(members.size()) + " goldens (" + names +
                  "): " + cause_text(*members.front()));
  }
  return out;
}

std::string markdown(const std::vector<GoldenResult>& results, const std::string& pictures) {
  // A cell is one line without bars.
  const auto cell = [](std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) text.insert(i, 1, '\\');
    return text;
  };
  std::vector<std::string> failed, passed;
  for (const GoldenResult& r : results) {
    const GoldenVerdict& v = r.verdict;
    std::string why = cause_text(r);
    if (r.passes > 0)
      why = "flaky: " + std::to_string(r.passes) + " of " + std::to_string(r.repeats) + " repeats passed; " +
            why;
    const bool tested = v.rejection.empty();
    (v.passed() ? passed : failed)
        .push_back("| " + cell(r.name) + " | " + (v.passed() ? "passed" : "**failed**") + " | " +
                   cell(tested ? answers_text(r) : "") + " | " + cell(tested ? events_text(r) : "") + " | " +
                   cell(tested ? images_text(r) : "") + " | " + cell(v.passed() ? "" : why) + " |\n");
  }
  std::string out = "### Goldens: " + std::to_string(failed.size()) + " of " +
                    std::to_string(results.size()) +
                    " failed\n\n| scenario | verdict | answers | events and counters | images | cause |\n"
                    "| --- | --- | --- | --- | --- | --- |\n";
  for (const std::string& row : failed) out += row;
  for (const std::string& row : passed) out += row;
  for (const std::string& line : equal_causes(results)) out += "\n" + line + "\n";
  constexpr std::size_t kMostPictures = 20;
  std::size_t shown = 0;
  for (const GoldenResult& r : results)
    for (const report::Comparison& c : r.comparisons) {
      if (c.passed || (c.pngs[0].empty() && c.pngs[1].empty()) || ++shown > kMostPictures) continue;
      out += "\n" + c.title + ": " + c.text + "\n\n";
      for (std::size_t kind = 0; kind < std::size(kKinds); ++kind)
        if (!c.pngs[kind].empty())
          out += "<img width=\"240\" alt=\"" + std::string(kKinds[kind]) + "\" src=\"" +
                 render::escape_markup(pictures + "/" + file_of(c.id, r.name, kKinds[kind])) + "\">\n";
    }
  return out;
}

std::string junit_xml(const std::vector<GoldenResult>& results) {
  std::size_t failures = 0, errors = 0;
  double seconds = 0;
  std::string cases;
  for (const GoldenResult& r : results) {
    errors += r.verdict.rejection.empty() ? 0 : 1;
    failures += r.verdict.rejection.empty() && !r.verdict.passed() ? 1 : 0;
    seconds += r.seconds;
    cases += case_xml(r);
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"lrbscope golden\" tests=\"" +
         std::to_string(results.size()) + "\" failures=\"" + std::to_string(failures) + "\" errors=\"" +
         std::to_string(errors) + "\" time=\"" + io::fixed_text(seconds, kDecimals) + "\">\n" + cases +
         "</testsuite>\n";
}

}  // namespace lrb::golden
