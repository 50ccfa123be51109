#include "scenarios/crowd/crowd_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "engine/core/atomic_file.hpp"
#include "engine/lrb/lrb_file.hpp"
#include "render/overlay.hpp"
#include "scenarios/crowd/crowd_frames.hpp"
#include "scenarios/crowd/crowd_json.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/page/page.hpp"
#include "scenarios/run/run_report.hpp"
#include "trace/hex.hpp"

namespace lrb::crowd {
namespace {

class FileSink final : public trace::ByteSink {
 public:
  explicit FileSink(const std::string& path) : file_(path) {}
  void write(std::string_view bytes) override { file_.write(bytes); }
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
};

std::vector<report::PageNumber> numbers(const spec::Crowd& crowd, const CrowdRun& run) {
  const std::uint64_t n = run.motion.body_count(), all = n * (n - 1) / 2;
  std::uint64_t asked = 0, met = 0, faces = 0, tests = 0;
  for (const CrowdStep& s : run.steps) {
    asked += s.queries.size();
    met += static_cast<std::uint64_t>(
        std::count_if(s.queries.begin(), s.queries.end(), [](const CrowdQuery& q) { return q.meets(); }));
    tests += sum(s).face_tests;
  }
  for (std::uint32_t i = 0; i < n; ++i) faces += run.rep(i).real_face_count();
  const auto a_step = [&](std::uint64_t x) {
    const double mean = static_cast<double>(x) / static_cast<double>(run.steps.size());
    constexpr double kWholeFrom = 1000;
    return mean < kWholeFrom ? render::short_number(mean)
                             : render::group_digits(static_cast<std::uint64_t>(std::round(mean)));
  };
  return {{"Bodies", render::group_digits(n),
           "of " + std::to_string(crowd.kinds.size()) + (crowd.kinds.size() == 1 ? " kind, " : " kinds, ") +
               render::group_digits(faces) + " real faces"},
          {"Time steps", render::group_digits(run.steps.size()), ""},
          {"Boxes that meet", a_step(asked), "of " + render::group_digits(all) + " pairs of bodies, a step"},
          {"Bodies that meet", a_step(met), "pairs a step"},
          {"Face tests", a_step(tests), "exact comparisons of two faces, a step"}};
}

report::PageChart chart(const char* title, const char* y_label) {
  report::PageChart c;
  c.title = title;
  c.x_label = "time step";
  c.y_label = y_label;
  c.cursor = report::PageCursor::step;
  return c;
}

void add_series(report::PageChart& c, const CrowdRun& run, const char* label,
                const std::function<double(const CrowdStep&)>& value) {
  report::PageSeries s;
  s.label = label;
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    s.x.push_back(static_cast<double>(i));
    s.y.push_back(value(run.steps[i]));
  }
  if (std::any_of(s.y.begin(), s.y.end(), [](double y) { return y > 0; })) c.series.push_back(std::move(s));
}

std::vector<report::PageChart> charts(const CrowdRun& run) {
  const std::size_t n = run.motion.body_count();
  const auto number = [](std::size_t x) { return static_cast<double>(x); };
  report::PageChart bodies = chart("Pairs of bodies, step by step", "pairs in the step");
  add_series(bodies, run, "boxes meet", [&](const CrowdStep& s) { return number(s.queries.size()); });
  add_series(bodies, run, "crossing",
             [&](const CrowdStep& s) { return number(count(s, Relation::crossing)); });
  add_series(bodies, run, "touching",
             [&](const CrowdStep& s) { return number(count(s, Relation::touching)); });
  add_series(bodies, run, "one inside the other", [&](const CrowdStep& s) {
    return number(count(s, Relation::a_inside_b) + count(s, Relation::b_inside_a));
  });
  add_series(bodies, run, "bodies in contact",
             [&](const CrowdStep& s) { return number(bodies_in_contact(s, n)); });
  report::PageChart work = chart("Work, step by step", "number in the step");
  add_series(work, run, "face tests", [&](const CrowdStep& s) { return number(sum(s).face_tests); });
  add_series(work, run, "refinements", [&](const CrowdStep& s) { return number(sum(s).refinements); });
  report::PageChart broad = chart("Broad phase, step by step", "number in the step");
  add_series(broad, run, "box tests", [&](const CrowdStep& s) { return number(s.broad_phase.box_tests); });
  add_series(broad, run, "swaps in the order",
             [&](const CrowdStep& s) { return number(s.broad_phase.swaps); });
  std::vector<report::PageChart> out;
  for (report::PageChart* c : {&bodies, &work, &broad})
    if (run.steps.size() > 1 && !c->series.empty()) out.push_back(std::move(*c));
  return out;
}

std::string words(Relation r) {
  std::string out = to_string(r);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

report::PageTable last_queries(const spec::Crowd& crowd, const CrowdRun& run) {
  constexpr std::size_t kMostRows = 200;
  report::PageTable t;
  t.title = "Bodies that meet at step " + std::to_string(run.steps.size() - 1);
  t.columns = {"A",          "B",           "relation",   "pairs of faces", "contact regions",
               "face tests", "refinements", "fingerprint"};
  const bool regions = crowd.request.contacts;
  if (!regions) t.columns.erase(t.columns.begin() + 4);
  std::size_t left_out = 0;
  for (const CrowdQuery& q : run.steps.back().queries) {
    if (!q.meets()) continue;
    if (t.rows.size() == kMostRows) {
      ++left_out;
      continue;
    }
    const trace::StepResult& r = q.result;
    t.rows.push_back({run.names[q.bodies.i], run.names[q.bodies.j], words(r.relation),
                      render::group_digits(r.pair_count), render::group_digits(q.contact_regions),
                      render::group_digits(r.counters.face_tests),
                      render::group_digits(r.counters.refinements), trace::to_hex(r.fingerprint)});
    if (!regions) t.rows.back().erase(t.rows.back().begin() + 4);
  }
  t.note = "Of pairs whose boxes do not meet nothing is asked: they have no point in common.";
  if (left_out > 0) t.note += " " + std::to_string(left_out) + " more are left out here.";
  return t;
}

report::Page crowd_page(const spec::Crowd& crowd, const CrowdRun& run, const run::DrawnFrames& drawn,
                        const std::string& folder, const std::string& command,
                        std::vector<report::PageLink> links) {
  report::Page page;
  page.title = crowd.name;
  page.purpose = crowd.purpose;
  page.verdict = std::to_string(run.motion.body_count()) + " bodies";
  page.command = command;
  page.numbers = numbers(crowd, run);
  run::add_frames(page, drawn, folder);
  page.charts = charts(run);
  page.tables.push_back(last_queries(crowd, run));
  page.links = std::move(links);
  if (!drawn.frames.empty())
    page.links.push_back(
        {"frames/", "frames/", std::to_string(drawn.frames.size()) + " full pictures (PNG)"});
  page.footer = report::footer(trace::lrbscope_version());
  return page;
}

report::PageLink trace_link(const spec::Crowd& crowd, const std::string& file) {
  return {file, file,
          crowd.clock == trace::Clock::event
              ? "every query on the tracks of its bodies; drag it onto ui.perfetto.dev"
              : "every query on the track of its thread; drag it onto ui.perfetto.dev"};
}

void write_pictures_and_page(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                             const std::string& command, std::vector<report::PageLink> links,
                             const run::ProgressReport& progress) {
  const std::vector<std::pair<std::string, std::string>> text = {
      {"Software", std::string("lrbscope ") + trace::lrbscope_version()},
      {"lrbscope:crowd", crowd.name},
      {"lrbscope:crowd_hash", trace::to_hex(crowd.hash)},
  };
  const run::DrawnFrames drawn = draw_crowd(crowd, run, folder, text, progress);
  progress("page", 0, 1);
  io::write_text(folder + "/index.html",
                 report::page_html(crowd_page(crowd, run, drawn, folder, command, std::move(links))));
}

}  // namespace

std::string write_crowd(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                        const std::string& command, const run::ProgressReport& progress) {
  run::check_frame_size(crowd.frames);
  make_folder(folder);
  const io::FolderLock lock(folder);
  io::refuse_links(folder);
  FileSink sink(folder + "/trace.json");
  write_crowd_trace(crowd, run, sink);
  sink.commit();
  const std::string summary = crowd_summary(crowd, run);
  io::write_text(folder + "/summary.json", summary);
  io::write_text(folder + "/timing.json", crowd_timing(run));
  for (std::size_t k = 0; k < run.kinds.size(); ++k)
    save_lrb(run.kinds[k].rep, folder + "/" + crowd.kinds[k].name + ".lrb");
  write_pictures_and_page(crowd, run, folder, command,
                          {trace_link(crowd, "trace.json"),
                           {"summary.json", "summary.json", "every step and every answer as JSON"},
                           {"timing.json", "timing.json", "how long each step took"}},
                          progress);
  return summary;
}

void redraw_crowd(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                  const std::string& command, const std::string& trace_file,
                  const run::ProgressReport& progress) {
  make_folder(folder);
  const io::FolderLock lock(folder);
  io::refuse_links(folder);
  const std::string file = std::filesystem::relative(trace_file, folder).generic_string();
  write_pictures_and_page(crowd, run, folder, command, {trace_link(crowd, file)}, progress);
}

std::string crowd_speed(const CrowdRun& run) {
  std::vector<double> broad_phases, queries;
  for (const CrowdStep& s : run.steps) {
    broad_phases.push_back(static_cast<double>(s.broad_phase_ns) / 1000);
    queries.push_back(static_cast<double>(s.queries_ns) / 1000);
  }
  const auto median = [](std::vector<double>& x) {
    const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
    std::nth_element(x.begin(), middle, x.end());
    return render::short_number(*middle) + " us";
  };
  return "a step takes (medians): broad phase " + median(broad_phases) + ", queries " + median(queries) +
         ", on " + std::to_string(run.threads) + (run.threads == 1 ? " thread" : " threads");
}

}  // namespace lrb::crowd
