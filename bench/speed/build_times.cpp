#include "bench/speed/build_times.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>

#include "bench/methods/triangles.hpp"
#include "bench/speed/bench_runner.hpp"
#include "bench/speed/peer_table.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb {

template <>
inline constexpr auto kFields<speed::BuildTime> =
    std::tuple{field("body", &speed::BuildTime::body),
               field("method", &speed::BuildTime::method),
               field("round", &speed::BuildTime::round),
               field("outcome", &speed::BuildTime::outcome),
               field("message", &speed::BuildTime::message, Kept::if_set),
               field("build_ms", &speed::BuildTime::build_ms),
               field("build_cpu_ms", &speed::BuildTime::build_cpu_ms),
               field("first_ms", &speed::BuildTime::first_ms),
               field("first_cpu_ms", &speed::BuildTime::first_cpu_ms),
               field("heap_bytes", &speed::BuildTime::heap_bytes),
               field("contact", &speed::BuildTime::contact)};
static_assert(covers_all_fields<speed::BuildTime>);

}  // namespace lrb

namespace lrb::speed {
namespace {

/// A structure of lrbscope. Variants have the same colour and shape.
struct Structure {
  const char *name, *title, *remark, *colour, *shape;
  LrbRep (*make)(const Mesh& mesh, const std::string& file);
};

constexpr unsigned kAllCores = 0;

LrbRep tree_of(const Mesh& mesh, unsigned threads) {
  constexpr bool kClosed = true, kSelfIntersecting = false;
  return LrbRep::without_regions(mesh, kClosed, kSelfIntersecting, threads);
}

LrbRep regions_of(const Mesh& mesh, unsigned threads) {
  BuildOptions options;
  options.threads = threads;
  return build_lrb(mesh, options);
}

constexpr Structure kStructures[] = {
    {"tree", "lrbscope, OBB tree", "answers exactly; one thread", "#0072b2", "circle",
     [](const Mesh& mesh, const std::string&) { return tree_of(mesh, 1); }},
    {"tree-threads", "lrbscope, OBB tree, all cores", "the same bytes", "#0072b2", "circle",
     [](const Mesh& mesh, const std::string&) { return tree_of(mesh, kAllCores); }},
    {"lrb", "lrbscope, LRB-rep", "also answers to a tolerance; one thread, mesh checks included", "#4aa3dc",
     "rect", [](const Mesh& mesh, const std::string&) { return regions_of(mesh, 1); }},
    {"lrb-threads", "lrbscope, LRB-rep, all cores", "the same bytes", "#4aa3dc", "rect",
     [](const Mesh& mesh, const std::string&) { return regions_of(mesh, kAllCores); }},
    {"lrb-loaded", "lrbscope, .lrb file", "an LRB-rep with its tree and levels of detail, read from a file",
     "#1c1e22", "star", [](const Mesh&, const std::string& file) { return load_lrb(file); }},
};

double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Measures build(), build() and ask() in this order. ask() returns whether the bodies intersect.
template <class Build, class Ask>
void measure(BuildTime& t, const Build& build, const Ask& ask) {
  const double heap = heap_bytes(), cpu = cpu_ms();
  const methods::Stopwatch watch;
  const auto a = build();
  t.build_ms = watch.microseconds() / 1e3;
  t.build_cpu_ms = cpu_ms() - cpu;
  t.heap_bytes = heap_bytes() - heap;
  const auto b = build();
  t.contact = ask(*a, *b);
  t.first_ms = watch.microseconds() / 1e3;
  t.first_cpu_ms = cpu_ms() - cpu;
}

/// The pose of the first answer: moved by a tenth of the bounding box, so that the surfaces intersect.
Pose pose_of_first_answer(const LrbRep& rep) {
  Pose pose;
  pose.t = 0.1 * shapes::box_of(rep).sizes();
  return pose;
}

}  // namespace

std::vector<methods::MethodInfo> own_structures() {
  std::vector<methods::MethodInfo> out;
  for (const Structure& s : kStructures) {
    methods::MethodInfo info;
    info.name = s.name;
    info.title = s.title;
    info.remark = s.remark;
    info.role = methods::Role::ours_other;
    info.style = {s.title, s.colour, s.shape};
    out.push_back(info);
  }
  return out;
}

BuildTime time_build(const methods::MethodEntry* entry, const std::string& method, const std::string& file) {
  BuildTime t;
  t.method = method;
  const LrbRep source = load_lrb(file);
  const Pose pose = pose_of_first_answer(source);
  workers::note_failures(t, [&] {
    if (entry != nullptr) {
      const std::unique_ptr<methods::Method> engine = entry->make();
      return measure(
          t, [&] { return engine->build(source); },
          [&](const methods::MethodBody& a, const methods::MethodBody& b) {
            return engine->query(a, {}, b, pose, Mode::first_pair).contact;
          });
    }
    const auto* s = std::find_if(std::begin(kStructures), std::end(kStructures),
                                 [&](const Structure& known) { return method == known.name; });
    if (s == std::end(kStructures)) throw InputError("unknown structure '" + method + "'");
    const Mesh mesh = methods::real_mesh(source);
    CollideRequest request;
    request.mode = Mode::any_pair;
    measure(
        t, [&] { return std::make_unique<LrbRep>(s->make(mesh, file)); },
        [&](const LrbRep& a, const LrbRep& b) {
          Workspace workspace;
          return !collide(a, {}, b, pose, request, workspace).value().pairs.empty();
        });
  });
  return t;
}

nlohmann::ordered_json to_json(const BuildTime& time) {
  return io::record_to_json(time);
}

namespace {

/// Writes the LRB-rep of a body, for the workers.
BuiltBody prepare(const Mesh& mesh, const std::string& folder) {
  BuildOptions options;
  options.threads = kAllCores;
  std::vector<std::string> notes;
  const LrbRep rep = bodies::build_from_mesh(check(mesh), options, notes);
  rep.levels(kAllCores);
  BuiltBody body;
  body.name = mesh.name;
  body.faces = rep.real_simplex_count();
  const std::string file = folder + "/" + body.name + ".lrb", faces = folder + "/" + body.name + ".faces.lrb";
  save_lrb(rep, file);
  save_lrb(LrbRep::without_regions(rep), faces);
  body.lrb_bytes = static_cast<double>(std::filesystem::file_size(file));
  body.faces_bytes = static_cast<double>(std::filesystem::file_size(faces));
  std::filesystem::remove(faces);
  return body;
}

}  // namespace

BuildResults survey_builds(const BuildSurvey& survey, const record::ProgressReport& progress) {
  BuildResults out;
  out.rounds = survey.rounds;
  for (const BodyPair& pair : survey.bodies) {
    progress("bodies", out.bodies.size(), survey.bodies.size());
    Mesh mesh = pair.a();
    // Results and files are found by the name: bodies of one kind and several sizes share that of the kind.
    const std::string stem = std::filesystem::path(mesh.name).stem().string();
    const auto is_taken = [&](const std::string& name) {
      return std::any_of(out.bodies.begin(), out.bodies.end(),
                         [&](const BuiltBody& body) { return body.name == name; });
    };
    mesh.name = stem;
    for (int k = 2; is_taken(mesh.name); ++k) mesh.name = stem + "-" + std::to_string(k);
    out.bodies.push_back(prepare(mesh, survey.folder));
  }
  // lrbscope's structures are measured by a worker, too.
  std::vector<workers::WorkerMethod> all;
  for (const methods::MethodInfo& info : own_structures()) all.emplace_back(workers::main_worker(), info);
  all.insert(all.end(), survey.methods.begin(), survey.methods.end());
  out.methods = workers::infos_of(all);
  const std::size_t total = survey.rounds * out.bodies.size() * all.size();
  for (unsigned round = 0; round < survey.rounds; ++round)
    for (const BuiltBody& body : out.bodies)
      for (const workers::WorkerMethod& m : all) {
        progress("builds", out.times.size(), total);
        workers::WorkerFailure failure;
        workers::Worker worker(m.command);
        BuildTime t;
        if (const auto line =
                worker.ask(nlohmann::json{{"build", survey.folder + "/" + body.name + ".lrb"}}.dump(),
                           std::chrono::duration<double>(survey.timeout), failure))
          t = io::record_from_json<BuildTime>(nlohmann::json::parse(*line));
        else
          workers::note_failure(t, failure);
        t.body = body.name;
        t.method = m.info.name;
        t.round = round;
        out.times.push_back(std::move(t));
      }
  progress("builds", total, total);
  return out;
}

namespace {

/// Median over the rounds, and span.
struct Spread {
  double median = 0, low = 0, high = 0;
};

Spread spread(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {median(values), values.front(), values.back()};
}

/// The results of a method for a body.
struct Cell {
  const BuiltBody* body;
  const methods::MethodInfo* method;
  Spread build, build_cpu, first, first_cpu;
  double heap = 0, saved = 0;       ///< bytes per face; saved 0: the engine writes no file
  double ratio = 0, ratio_cpu = 0;  ///< of the time to build to FCL's; 0: none
  std::string failure;
};

/// Returns the name of the engine that ratios refer to: FCL with lrbscope's flags, or FCL as packaged.
std::string reference_of(const BuildResults& r) {
  for (const methods::MethodInfo& m : r.methods)
    if (m.role == methods::Role::aim) return m.name;
  for (const methods::MethodInfo& m : r.methods)
    if (m.name == "fcl") return m.name;
  return "";
}

std::vector<Cell> cells_of(const BuildResults& r, const BuiltBody& body) {
  const std::string reference = reference_of(r);
  std::map<std::pair<std::string, std::uint64_t>, const BuildTime*> by_key;
  for (const BuildTime& t : r.times)
    if (t.body == body.name) by_key[{t.method, t.round}] = &t;
  std::vector<Cell> out;
  for (const methods::MethodInfo& m : r.methods) {
    Cell cell{&body, &m, {}, {}, {}, {}, 0, 0, 0, 0, ""};
    std::vector<const BuildTime*> times;
    // Ratios are taken within a round.
    std::vector<double> ratios, ratios_cpu;
    for (std::uint64_t round = 0; round < r.rounds; ++round) {
      const auto it = by_key.find({m.name, round});
      if (it == by_key.end()) continue;
      const BuildTime& t = *it->second;
      if (t.outcome != Outcome::answered) {
        cell.failure = std::string(name_of(t.outcome)) + ": " + t.message;
        continue;
      }
      times.push_back(&t);
      const auto fcl = by_key.find({reference, round});
      if (fcl == by_key.end() || fcl->second->outcome != Outcome::answered) continue;
      ratios.push_back(t.build_ms / fcl->second->build_ms);
      ratios_cpu.push_back(t.build_cpu_ms / fcl->second->build_cpu_ms);
    }
    const auto all = [&](double BuildTime::*q) {
      std::vector<double> values;
      for (const BuildTime* t : times) values.push_back(t->*q);
      return spread(values);
    };
    cell.build = all(&BuildTime::build_ms);
    cell.build_cpu = all(&BuildTime::build_cpu_ms);
    cell.first = all(&BuildTime::first_ms);
    cell.first_cpu = all(&BuildTime::first_cpu_ms);
    cell.heap = all(&BuildTime::heap_bytes).median / body.faces;
    if (m.name.starts_with("tree")) cell.saved = body.faces_bytes / body.faces;
    if (m.name.starts_with("lrb")) cell.saved = body.lrb_bytes / body.faces;
    cell.ratio = ratios.empty() ? 0 : median(ratios);
    cell.ratio_cpu = ratios_cpu.empty() ? 0 : median(ratios_cpu);
    out.push_back(std::move(cell));
  }
  return out;
}

std::string number(double value) {
  if (value == 0) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : 3, value);
  return text;
}

std::string with_span(const Spread& s) {
  return number(s.median) + " (" + number(s.low) + "-" + number(s.high) + ")";
}

const std::vector<std::string>& columns() {
  static const std::vector<std::string> names = {"structure", "build ms",    "CPU ms",
                                                 "/ FCL",     "CPU / FCL",   "first answer ms",
                                                 "CPU ms",    "heap B/face", "file B/face"};
  return names;
}

std::vector<std::string> row_of(const Cell& c) {
  if (c.build.median == 0) return {c.method->title, c.failure.empty() ? "-" : c.failure};
  return {c.method->title,     with_span(c.build), number(c.build_cpu.median), number(c.ratio),
          number(c.ratio_cpu), with_span(c.first), number(c.first_cpu.median), number(c.heap),
          number(c.saved)};
}

std::string head_of(const BuiltBody& body) {
  return body.name + ", " + std::to_string(body.faces) + " triangles";
}

std::string reference_line(const BuildResults& r) {
  const std::string reference = reference_of(r);
  for (const methods::MethodInfo& m : r.methods)
    if (m.name == reference) return "FCL: " + m.title + ".";
  return "FCL was not measured: no ratios.";
}

}  // namespace

std::string build_text(const BuildResults& r) {
  std::string out = "Median of " + std::to_string(r.rounds) +
                    " rounds (least-most), each build in its own process. First answer: two builds and one "
                    "yes-or-no query. " +
                    reference_line(r) + "\n";
  for (const BuiltBody& body : r.bodies) {
    std::vector<std::vector<std::string>> rows = {columns()};
    for (const Cell& c : cells_of(r, body)) rows.push_back(row_of(c));
    out += "\n" + head_of(body) + "\n" + report::in_columns(rows);
  }
  return out;
}

std::string build_csv(const BuildResults& r) {
  constexpr int kDigits = 6;
  report::Table table{"",
                      {"body", "faces", "method", "round", "outcome", "build_ms", "build_cpu_ms", "first_ms",
                       "first_cpu_ms", "heap_bytes", "contact"}};
  std::map<std::string, std::uint32_t> faces;
  for (const BuiltBody& body : r.bodies) faces[body.name] = body.faces;
  for (const BuildTime& t : r.times) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row = {t.body, std::to_string(faces[t.body]), t.method, std::to_string(t.round),
           std::string(name_of(t.outcome))};
    for (const double x : {t.build_ms, t.build_cpu_ms, t.first_ms, t.first_cpu_ms, t.heap_bytes})
      row.push_back(io::number_text(x, kDigits));
    row.push_back(t.contact ? "1" : "0");
  }
  return report::csv(table);
}

namespace {

/// Returns a style for each method: its own colour and shape, with another line for each further variant that
/// shares them.
std::map<std::string, report::SeriesStyle> line_styles(const std::vector<methods::MethodInfo>& methods) {
  std::map<std::string, report::SeriesStyle> out;
  std::map<std::pair<std::string, std::string>, int> variants;
  for (const methods::MethodInfo& m : methods) {
    const int variant = variants[{m.style.colour, m.style.shape}]++;
    out[m.name] = {variant == 0 ? report::Line::straight : report::Line::dashed, m.style.colour,
                   variant < 2 ? m.style.shape : "none"};
  }
  return out;
}

}  // namespace

report::Document build_page(const BuildResults& r, bool tex) {
  report::Document page("Building beside other engines",
                        "Time to build each structure from the same triangles, time to the first answer, and "
                        "memory.");
  page.tables_as_tex(tex);
  page.text(
      {"Measured",
       "Each build runs in its own process. A round runs all structures, one after the other; values are "
       "medians over rounds, with the least and the most. Times of other engines include the copy of the "
       "triangles into the engine's form."});
  page.text(
      {"First answer", "Two builds and one yes-or-no query of intersecting bodies, by the same process."});
  page.text(
      {"Ratios", "Median over rounds of the time relative to FCL's in the same round. " + reference_line(r)});
  struct Panel {
    const char *title, *axis;
    Spread Cell::*value;
  };
  std::vector<std::vector<Cell>> cells;  // (bodies)
  for (const BuiltBody& body : r.bodies) cells.push_back(cells_of(r, body));
  // From few triangles to many.
  std::vector<std::size_t> by_size(cells.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](std::size_t i, std::size_t k) { return r.bodies[i].faces < r.bodies[k].faces; });
  for (const Panel& panel :
       {Panel{"Build", "wall time, ms", &Cell::build}, Panel{"First answer", "wall time, ms", &Cell::first},
        Panel{"Build, all threads", "CPU time, ms", &Cell::build_cpu}}) {
    report::Chart chart{panel.title, {"triangles", true}, {panel.axis, true}};
    std::map<std::string, report::Series> series;
    const std::map<std::string, report::SeriesStyle> styles = line_styles(r.methods);
    for (const std::size_t i : by_size)
      for (const Cell& c : cells[i]) {
        const Spread& s = c.*panel.value;
        if (s.median == 0) continue;
        report::Series& line = series[c.method->name];
        line.label = c.method->title;
        line.style = styles.at(c.method->name);
        line.x.push_back(c.body->faces);
        line.y.push_back(s.median);
        line.low.push_back(s.low);
        line.high.push_back(s.high);
        line.notes.push_back(c.method->title + "\n" + head_of(*c.body) + "\n" + with_span(s) + " ms");
      }
    for (const methods::MethodInfo& m : r.methods)
      if (const auto it = series.find(m.name); it != series.end()) chart.series.push_back(it->second);
    page.chart(chart);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    report::Table table{head_of(r.bodies[i]), columns()};
    for (const Cell& c : cells[i]) {
      table.rows.push_back(row_of(c));
      table.rows.back().resize(columns().size());
    }
    page.table(table);
  }
  return page;
}

}  // namespace lrb::speed
