#include <filesystem>
#include <memory>
#include <optional>

#include "engine/core/error.hpp"
#include "scenarios/cli/command.hpp"
#include "scenarios/cli/options.hpp"
#include "scenarios/cli/progress.hpp"
#include "scenarios/golden/approve.hpp"
#include "scenarios/golden/golden_report.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/spec/shipped.hpp"

namespace lrb::cli {
namespace {

struct GoldenOptions {
  std::vector<std::string> scenarios;
  std::string goldens = "goldens", folder = "out/golden", variant, size;
  std::optional<std::uint32_t> frames;
  bool json = false;
};

std::string approve_command(const GoldenOptions& o, const std::string& name) {
  return "lrbscope golden approve --goldens " + shell_word(o.goldens) + " " + name;
}

struct NamedGolden {
  std::string name;
  std::optional<spec::Scenario> scenario;  ///< nothing unless it has been opened
};

/// Finds a golden by its own name, or by its scenario: the name of a shipped one, or a file.
NamedGolden find_golden(const GoldenOptions& o, const std::string& word) {
  if (golden::has_golden(o.goldens, word)) return {word, std::nullopt};
  spec::Scenario scenario = spec::open_scenario(word);
  if (!golden::has_golden(o.goldens, scenario.name))
    throw InputError(word + ": no golden in " + o.goldens +
                     " yet; make it with: lrbscope golden approve --goldens " + shell_word(o.goldens) + " " +
                     shell_word(word));
  return {scenario.name, std::move(scenario)};
}

std::vector<NamedGolden> goldens_to_test(const GoldenOptions& o) {
  std::vector<NamedGolden> out;
  if (o.scenarios.empty())
    for (const std::string& name : golden::golden_names(o.goldens)) out.push_back({name, std::nullopt});
  for (const std::string& word : o.scenarios) out.push_back(find_golden(o, word));
  return out;
}

std::string as_json(const golden::GoldenResult& r) {
  nlohmann::ordered_json images = nlohmann::ordered_json::array();
  for (const golden::ImageVerdict& v : r.verdict.images)
    images.push_back({{"file", v.file}, {"passed", v.passed}, {"equal", v.equal}, {"text", v.text}});
  nlohmann::ordered_json line = {{"scenario", r.name},    {"passed", r.verdict.passed()},
                                 {"steps", r.steps},      {"events", r.events},
                                 {"divergence", nullptr}, {"images", std::move(images)}};
  if (!r.verdict.refusal.empty()) line["refusal"] = r.verdict.refusal;
  if (r.verdict.divergence) line["divergence"] = r.verdict.divergence->message();
  if (!r.verdict.diagnosis.empty()) line["diagnosis"] = r.verdict.diagnosis;
  if (!r.verdict.passed()) line["approve"] = r.approve;
  return one_line(line);
}

/// Tests one golden. One that is damaged or refused fails by itself; the others are tested all the same.
golden::GoldenResult test_one(const GoldenOptions& o, const Globals& globals, const NamedGolden& g,
                              bool report, std::optional<golden::GoldenRun>& run) {
  const std::string approve = approve_command(o, g.name);
  try {
    const golden::Golden golden = golden::load_golden(o.goldens, g.name);
    spec::Scenario scenario =
        g.scenario ? *g.scenario : golden::golden_scenario(o.goldens, g.name, golden.spec);
    run = golden::play_golden(std::move(scenario), golden.spec, progress_report(globals.quiet));
    return golden::test_golden(golden, *run, approve, report);
  } catch (const InputError& e) {
    run.reset();
    return golden::untested_golden(g.name, e.what(), approve);
  }
}

/// `report`: writes a page in any case, with every picture on it.
int run_test(const GoldenOptions& o, const Globals& globals, bool report) {
  const std::vector<NamedGolden> todo = goldens_to_test(o);
  std::vector<std::string> names;
  for (const NamedGolden& g : todo) names.push_back(g.name);
  std::optional<io::FolderLock> lock;
  const auto lock_folder = [&] {
    io::make_folder(o.folder);
    if (!lock) lock.emplace(o.folder);
  };
  if (report || std::filesystem::exists(o.folder)) lock_folder();
  golden::clear_golden_report(o.folder, names);
  std::vector<golden::GoldenResult> results;
  bool passed = true;
  for (const NamedGolden& g : todo) {
    std::optional<golden::GoldenRun> run;
    results.push_back(test_one(o, globals, g, report, run));
    passed = passed && results.back().verdict.passed();
    if (!passed) lock_folder();
    if (run) golden::write_failures(results.back(), *run, o.folder);
    print(o.json ? as_json(results.back()) : golden::result_text(results.back()));
  }
  if (report || !passed) {
    golden::write_golden_page(results, o.folder, globals.command_line);
    if (!o.json) print(o.folder + "/index.html\n");
  }
  return passed ? kOk : kMismatch;
}

golden::GoldenSpec spec_to_approve(const GoldenOptions& o, const std::string& name,
                                   const spec::Scenario& scenario, const std::string& word) {
  golden::GoldenSpec spec;
  if (golden::has_golden(o.goldens, name)) {
    spec = golden::read_golden_spec(o.goldens, name);
    if (name != word) spec.scenario = golden::scenario_reference(o.goldens, scenario, word);
  } else {
    golden::set_default_size(spec, scenario.frames);
    spec.scenario = golden::scenario_reference(o.goldens, scenario, word);
  }
  if (!o.size.empty()) {
    PictureOptions picture;
    picture.size = o.size;
    spec::FrameSpec frames;
    apply(picture, frames);
    spec.width = frames.width;
    spec.height = frames.height;
  }
  if (o.frames) spec.frames = *o.frames;
  return spec;
}

int run_approve(const GoldenOptions& o, const Globals& globals) {
  const std::vector<std::string> words = o.scenarios.empty() ? golden::golden_names(o.goldens) : o.scenarios;
  for (const std::string& word : words) {
    spec::Scenario scenario =
        golden::has_golden(o.goldens, word)
            ? golden::golden_scenario(o.goldens, word, golden::read_golden_spec(o.goldens, word))
            : spec::open_scenario(word);
    const std::string name = scenario.name;
    const golden::GoldenSpec spec = spec_to_approve(o, name, scenario, word);
    const golden::GoldenRun run =
        golden::play_golden(std::move(scenario), spec, progress_report(globals.quiet));
    const std::vector<std::string> done = golden::approve_golden(o.goldens, spec, run, o.variant);
    for (const std::string& line : done) print(line + "\n");
    if (done.empty()) print("unchanged " + name + "\n");
  }
  return kOk;
}

CLI::App* add_part(CLI::App& golden, const std::string& name, const std::string& what,
                   const std::shared_ptr<GoldenOptions>& o, const std::string& none) {
  CLI::App* app = golden.add_subcommand(name, what);
  app->add_option("SCENARIO", o->scenarios, "Shipped scenarios, or JSON files [" + none + "]");
  app->add_option("--goldens", o->goldens, "Folder with what is approved")
      ->type_name("DIR")
      ->capture_default_str();
  return app;
}

void add_output(CLI::App& app, const std::shared_ptr<GoldenOptions>& o) {
  app.add_option("-o,--output", o->folder, "Folder for the page and for what differs")
      ->type_name("DIR")
      ->capture_default_str();
  app.add_flag("--json", o->json, "Print a line of JSON for each scenario");
}

Command add_golden(CLI::App& root, const Globals& globals) {
  CLI::App* app = root.add_subcommand("golden", "Compare runs with approved traces and pictures");
  const auto o = std::make_shared<GoldenOptions>();
  app->require_subcommand(1);
  CLI::App* test =
      add_part(*app, "test", "Compare; if events, counters or pictures differ, write a page and exit with 1",
               o, "all goldens");
  add_output(*test, o);
  CLI::App* approve = add_part(
      *app, "approve", "Approve today's runs where they differ: make them the goldens", o, "all goldens");
  approve
      ->add_option("--variant", o->variant,
                   "Put pictures that differ beside the approved ones, under this name")
      ->type_name("NAME");
  approve->add_option("--size", o->size, "Size of the pictures [480 wide, of the scenario's shape]")
      ->type_name("WxH");
  approve->add_option("--frames", o->frames, "Number of pictures, evenly chosen from the scenario's [3]")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  CLI::App* report =
      add_part(*app, "report", "As test, but always with a page, of every picture", o, "all goldens");
  add_output(*report, o);
  return {app, [o, &globals, test, report] {
            if (test->parsed()) return run_test(*o, globals, false);
            if (report->parsed()) return run_test(*o, globals, true);
            return run_approve(*o, globals);
          }};
}

}  // namespace

std::vector<CommandEntry> golden_commands() {
  return {{add_golden, 90}};
}

}  // namespace lrb::cli
