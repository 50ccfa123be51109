#include "tools/import.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>

#include "scenarios/compare/side_by_side.hpp"
#include "scenarios/profile/captured_run.hpp"
#include "scenarios/record/engine_run.hpp"
#include "scenarios/report/document.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
namespace lrb::tools {
namespace {

struct ImportOptions {
  std::string file, folder, queries;
  bool no_check = false, trace = false;
  PictureOptions picture;
};

/// The imported run of a pair of trees.
struct Imported {
  std::string folder;  ///< relative to the page that lists all runs; empty: this is the only run
  std::string name;
  record::EngineTotals totals;
};

Imported import_pair(const ImportOptions& o, const Globals& globals, const capture::Capture& c,
                     const profile::TreePair& pair, const std::string& folder) {
  const record::ProgressReport progress = progress_report(globals.quiet);
  std::vector<bodies::LoadedBody> bodies = profile::captured_bodies(c, pair);
  note(globals, bodies[0].notes);
  if (c.trees[pair.trees[0]].mesh != c.trees[pair.trees[1]].mesh) note(globals, bodies[1].notes);
  spec::Scenario scenario = profile::captured_scenario(c, pair, bodies, o.file);
  PictureOptions picture = o.picture;
  resolve_up(picture.camera.up, bodies[0].rep, globals);
  apply(picture, scenario.frames);
  scenario.keeps_trace = o.trace;
  if (o.trace) scenario.event_cap = 5'000'000;  // a trace of about a gigabyte
  scenario.gzip = true;  // an engine's events are many; viewers read compressed traces as well
  profile::CapturedRunSettings settings = profile::captured_settings(scenario, c, pair, o.file);
  settings.check = !o.no_check;
  record::Recording recording = profile::captured_run(c, pair, std::move(bodies), settings, progress);
  choose_views(picture.camera, scenario, recording);
  const run::RunOutcome outcome = run::write_run(scenario, recording, folder, globals.command_line, progress);
  note(globals, outcome.notes);
  return {{}, scenario.name, record::totals_of(recording)};
}

std::string without_tree_words(std::uint64_t n) {
  return render::counted(n, "query", "queries") +
         " with a single triangle or shape instead of a tree on one side " + (n == 1 ? "is" : "are") +
         " left out; describe the shape by a mesh to see it (LRBCAP_SHAPE)";
}

/// Writes the page that lists the runs of several pairs of trees.
void write_list(const std::string& folder, const Globals& globals, const capture::Capture& c,
                const std::string& file, const std::vector<Imported>& runs, const std::string& left_out,
                const record::EngineTotals& all) {
  using render::group_digits;
  const report::Folder locked(folder);
  report::Document doc(printable_name(std::filesystem::path(file).filename().string()),
                       "Recorded in " + c.engine + ". A run for each pair of trees with queries." +
                           (left_out.empty() ? "" : " " + left_out + "."));
  report::Table table{"Pairs of trees",
                      {"run", "bodies", "queries", "events", "right", "missed", "false", "wrong verdicts"}};
  for (const Imported& run : runs) {
    const record::EngineTotals& t = run.totals;
    table.rows.push_back(
        {run.folder, run.name, group_digits(t.queries), group_digits(t.node_pairs + t.face_tests),
         t.checked ? group_digits(t.right) : "", t.checked ? group_digits(t.missed) : "",
         t.checked ? group_digits(t.false_pairs) : "", t.checked ? group_digits(t.wrong_verdicts) : ""});
    doc.link({run.folder + "/index.html", t.words(), run.name});
  }
  table.note = "Right, missed and false: pairs of triangles, compared with exact answers.";
  doc.verdict(!all.checked            ? "answers not checked"
              : all.wrong_queries > 0 ? "wrong answers"
                                      : "no wrong answer",
              all.wrong_queries == 0);
  doc.command(globals.command_line).text({"All", all.words()}).table(table).write(locked);
}

int run_import(const ImportOptions& o, const Globals& globals) {
  const QueryRange range = parse_queries(o.queries);
  capture::Capture c = capture::read_capture(o.file, range.first, range.last);
  if (c.engine.empty()) c.engine = "another engine";
  profile::describe_probes(c);
  profile::TreePairs found = profile::tree_pairs(c);
  const std::string name = printable_name(o.file);
  if (found.pairs.empty())
    throw InputError(name + ": expected queries of two trees, found none" +
                     (found.without_tree > 0 ? "; " + without_tree_words(found.without_tree)
                      : o.queries.empty()    ? ""
                                             : " in --queries " + o.queries));
  const std::string folder = o.folder.empty() ? "out/import" : o.folder;
  std::vector<std::string> notes;
  if (c.cut_off)
    notes.push_back(name + ": the capture ends within a chunk or without its end; the rest was read");
  std::string left_out;
  if (found.without_tree > 0)
    notes.push_back(name + ": " + (left_out = without_tree_words(found.without_tree)));
  // A scene of many bodies, or trees that are refitted, make many pairs.
  constexpr std::size_t kMaxPairs = 24;
  if (found.pairs.size() > kMaxPairs) {
    std::stable_sort(found.pairs.begin(), found.pairs.end(),
                     [](const auto& x, const auto& y) { return x.queries.size() > y.queries.size(); });
    const std::string words = render::group_digits(found.pairs.size() - kMaxPairs) + " of " +
                              render::group_digits(found.pairs.size()) +
                              " pairs of trees, those with the fewest queries, are left out (--queries)";
    found.pairs.resize(kMaxPairs);
    notes.push_back(name + ": " + words);
    left_out += (left_out.empty() ? "" : ". ") + words;
  }
  note(globals, notes);
  record::EngineTotals totals;
  if (found.pairs.size() == 1) {
    totals = import_pair(o, globals, c, found.pairs[0], folder).totals;
  } else {
    compare::reject_folder_of_run(folder);
    std::vector<Imported> runs;
    for (std::size_t i = 0; i < found.pairs.size(); ++i) {
      const std::string part = "pair_" + std::to_string(i + 1);
      runs.push_back(import_pair(o, globals, c, found.pairs[i], folder + "/" + part));
      runs.back().folder = part;
      totals += runs.back().totals;
    }
    write_list(folder, globals, c, o.file, runs, left_out, totals);
  }
  print(c.engine + (c.every > 1 ? ", one of " + std::to_string(c.every) + " queries" : "") + ": " +
        totals.words() + "; " + render::counted(totals.node_pairs + totals.face_tests, "event", "events") +
        "\n" + folder + "/index.html\n");
  if (totals.wrong_queries > 0) note(globals, {shell_line({"check", o.file}) + " names the cause of each"});
  return kOk;
}

}  // namespace

QueryRange parse_queries(const std::string& text) {
  QueryRange out;
  if (text.empty()) return out;
  const char *at = text.data(), *const end = text.data() + text.size();
  const auto number = [&](std::uint32_t& value) {
    const auto [after, error] = std::from_chars(at, end, value);
    if (error != std::errc()) return false;
    at = after;
    return true;
  };
  bool ok = number(out.first);
  if (ok && at == end) {
    out.last = out.first;
  } else if (ok && *at == '-') {
    ++at;
    ok = at == end || number(out.last);
  }
  if (!ok || at != end || out.first == 0 || out.last < out.first)
    throw InputError("--queries: expected numbers from 1 as 40-60, 40- or 40, found '" +
                     printable_name(text) + "'");
  return out;
}

void write_query_page(capture::Capture capture, const std::string& source, const std::string& folder,
                      const Globals& globals) {
  profile::describe_probes(capture);
  const profile::TreePairs found = profile::tree_pairs(capture);
  if (found.pairs.empty()) throw InputError(source + ": " + without_tree_words(found.without_tree));
  ImportOptions options;
  options.file = source;
  import_pair(options, globals, capture, found.pairs[0], folder);
}

Command add_import(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "import", "Show queries of any collision engine, captured with lrbscope_capture.h, and check them");
  const auto o = std::make_shared<ImportOptions>();
  app->add_option("CAPTURE", o->file, "Capture, as written by a program with lrbscope_capture.h")->required();
  app->add_option("-o,--output", o->folder, "DIR", "Output folder [out/import]");
  app->add_option("--queries", o->queries, "FIRST-LAST",
                  "Only these queries, by number from 1: 40-60, 40- or 40");
  app->add_flag("--no-check", o->no_check, "Do not compare the answers with exact ones");
  app->add_flag("--trace", o->trace,
                "Also write trace.json.gz, for compare, render, why, figure, export and Perfetto");
  add_picture_options(*app, o->picture);
  return {app, [o, &globals] { return run_import(*o, globals); }};
}

}  // namespace lrb::tools
