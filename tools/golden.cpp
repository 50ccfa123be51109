#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "scenarios/golden/approve.hpp"
#include "scenarios/golden/check.hpp"
#include "scenarios/golden/golden_report.hpp"
#include "scenarios/io/files.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::tools {
namespace {

struct GoldenOptions {
  std::vector<std::string> scenarios;
  std::string goldens = "goldens", folder = "out/golden", variant, size;
  std::optional<std::uint32_t> frames;
  std::vector<golden::Level> levels;      ///< nullopt: as in each golden
  std::optional<double> large_share;      ///< of pixels; nullopt: as in each golden
  std::optional<double> work;             ///< nullopt: as in each golden
  std::vector<std::string> ignore, only;  ///< of pictures; empty: as in each golden
  std::string junit, markdown, picture_url, from;
  unsigned jobs = 1;
  std::uint32_t repeat = 0;
  bool json = false, dry = false;
};

/// Applies the comparison options of the command line.
void apply(const GoldenOptions& o, golden::GoldenSpec& spec) {
  if (!o.levels.empty()) {
    spec.levels = {};
    for (const golden::Level level : o.levels) spec.levels[static_cast<std::size_t>(level)] = true;
  }
  if (o.large_share) spec.tolerance.large_share = *o.large_share;
  if (o.work) spec.work = *o.work;
  const auto rectangles = [](const std::vector<std::string>& words, std::vector<render::PixelRect>& out) {
    if (!words.empty()) out.clear();
    for (const std::string& word : words) {
      render::PixelRect r;
      char end = 0;
      if (std::sscanf(word.c_str(), "%d,%d,%d,%d%c", &r.x, &r.y, &r.width, &r.height, &end) != 4 || r.x < 0 ||
          r.y < 0 || r.width < 1 || r.height < 1)
        throw InputError(printable_name(word) + ": expected a rectangle X,Y,WIDTH,HEIGHT in pixels");
      out.push_back(r);
    }
  };
  rectangles(o.ignore, spec.ignore);
  rectangles(o.only, spec.only);
}

std::string approve_command(const GoldenOptions& o, const std::string& name) {
  return "lrbscope golden approve --goldens " + shell_word(o.goldens) + " " + name;
}

struct NamedGolden {
  std::string name;
  std::optional<golden::Source> source;  ///< nullopt until it has been opened
};

/// Finds a golden by its own name, or by its source: the name of a shipped scenario, or a file.
NamedGolden find_golden(const GoldenOptions& o, const std::string& word) {
  if (golden::has_golden(o.goldens, word)) return {word, std::nullopt};
  if (word.find_first_of("./") == std::string::npos)
    throw InputError(word + ": no golden of this name in " + printable_name(o.goldens) +
                     io::suggestion(word, golden::golden_names(o.goldens)));
  golden::Source source = golden::open_source(word);
  const std::string name = golden::name_of(source);
  if (!golden::has_golden(o.goldens, name))
    throw InputError(word + ": no golden in " + o.goldens +
                     "; create it with: lrbscope golden approve --goldens " + shell_word(o.goldens) + " " +
                     shell_word(word));
  return {name, std::move(source)};
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
  nlohmann::ordered_json line = {
      {"scenario", r.name}, {"passed", r.verdict.passed()}, {"seconds", r.seconds},       {"steps", r.steps},
      {"events", r.events}, {"divergence", nullptr},        {"images", std::move(images)}};
  for (const golden::Effect& e : r.verdict.effects)
    line["effects"].push_back({{"step", e.step},
                               {"what", e.what},
                               {"expected", e.expected},
                               {"found", e.found},
                               {"answer", e.kind == golden::Effect::Kind::answer}});
  for (const std::string& cause : r.verdict.causes) line["causes"].push_back(cause);
  if (!r.verdict.rejection.empty()) line["refusal"] = r.verdict.rejection;
  if (r.verdict.divergence) line["divergence"] = r.verdict.divergence->message();
  if (!r.verdict.diagnosis.empty()) line["diagnosis"] = r.verdict.diagnosis;
  if (!r.verdict.passed()) line["approve"] = r.approve;
  return one_line(line);
}

/// A golden whose scenario has been run, or the reason why it could not be.
struct Tried {
  std::optional<golden::Golden> golden;
  std::optional<golden::GoldenRun> run;
  std::string rejection;
  double seconds = 0;
};

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

/// Loads a golden and runs its scenario. A damaged or rejected golden fails alone; the others are still
/// tested.
Tried try_one(const GoldenOptions& o, const NamedGolden& g, const record::ProgressReport& progress) {
  const auto began = Clock::now();
  Tried out;
  try {
    out.golden = golden::load_golden(o.goldens, g.name);
    apply(o, out.golden->spec);
    const golden::Source source =
        g.source ? *g.source : golden::golden_source(o.goldens, g.name, out.golden->spec);
    out.run = golden::record_golden(source, out.golden->spec, progress);
    out.run->text = golden::scenario_text(o.goldens, g.name, out.golden->spec);
  } catch (const InputError& e) {
    out.rejection = e.what();
  }
  out.seconds = seconds_since(began);
  return out;
}

/// Runs scenarios on several threads, at most --jobs ahead of the requested one, to limit memory.
class Trials {
 public:
  Trials(const GoldenOptions& o, const Globals& globals, const std::vector<NamedGolden>& todo)
      : o_(o), todo_(todo), progress_(o.jobs > 1 ? record::kSilent : progress_report(globals.quiet)) {}

  Tried take(std::size_t i) {
    if (o_.jobs <= 1) return try_one(o_, todo_[i], progress_);
    for (; begun_.size() < std::min(todo_.size(), i + o_.jobs);)
      begun_.push_back(std::async(std::launch::async, try_one, std::cref(o_), std::cref(todo_[begun_.size()]),
                                  std::cref(progress_)));
    return begun_[i].get();
  }

 private:
  const GoldenOptions& o_;
  const std::vector<NamedGolden>& todo_;
  record::ProgressReport progress_;
  std::vector<std::future<Tried>> begun_;
};

/// Draws the pictures of a run and compares them.
golden::GoldenResult judge(Tried& tried, const NamedGolden& g, const GoldenOptions& o, const Globals& globals,
                           bool report) {
  const auto began = Clock::now();
  const std::string approve = approve_command(o, g.name);
  golden::GoldenResult result;
  try {
    if (!tried.rejection.empty()) throw InputError(tried.rejection);
    golden::paint_golden(*tried.run, tried.golden->spec, progress_report(globals.quiet));
    result = golden::test_golden(*tried.golden, *tried.run, approve, report);
  } catch (const InputError& e) {
    tried.run.reset();
    result = golden::untested_golden(g.name, e.what(), approve);
  }
  result.seconds = tried.seconds + seconds_since(began);
  result.page = o.folder + "/index.html";
  return result;
}

/// `report`: writes a page in any case, with all pictures.
int run_test(const GoldenOptions& o, const Globals& globals, bool report) {
  const std::vector<NamedGolden> todo = goldens_to_test(o);
  std::vector<std::string> names;
  for (const NamedGolden& g : todo) names.push_back(g.name);
  std::optional<report::Folder> locked;
  const auto lock_folder = [&] {
    if (!locked) locked.emplace(o.folder);
  };
  if (report || std::filesystem::exists(o.folder)) lock_folder();
  golden::clear_golden_report(o.folder, names);
  std::vector<golden::GoldenResult> results;
  Trials trials(o, globals, todo);
  bool passed = true;
  for (std::size_t i = 0; i < todo.size(); ++i) {
    Tried tried = trials.take(i);
    results.push_back(judge(tried, todo[i], o, globals, report));
    // A test that sometimes passes depends on something other than its input.
    golden::GoldenResult& result = results.back();
    for (; !result.verdict.passed() && tried.run && result.repeats < o.repeat; ++result.repeats) {
      Tried again = try_one(o, todo[i], progress_report(globals.quiet));
      result.passes += judge(again, todo[i], o, globals, false).verdict.passed();
    }
    passed = passed && results.back().verdict.passed();
    if (!passed) lock_folder();
    if (tried.run) golden::write_failures(results.back(), *tried.run, o.folder);
    print(o.json ? as_json(results.back()) : golden::result_text(results.back()));
  }
  if (report || !passed) {
    golden::write_golden_page(results, *locked, globals.command_line);
    if (!o.json) print(o.folder + "/index.html\n");
  }
  if (!o.junit.empty()) io::write_text(o.junit, golden::junit_xml(results));
  for (const std::string& line : golden::equal_causes(results))
    if (!o.json) print(line + "\n");
  if (!o.markdown.empty()) {
    std::error_code error;
    const auto from = std::filesystem::absolute(o.markdown, error).parent_path();
    const std::string pictures =
        o.picture_url.empty()
            ? std::filesystem::absolute(o.folder, error).lexically_relative(from).generic_string()
            : o.picture_url;
    io::write_text(o.markdown, golden::markdown(results, pictures));
  }
  return passed ? kOk : kMismatch;
}

std::uintmax_t bytes_in(const std::string& folder) {
  std::uintmax_t bytes = 0;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(folder, error))
    if (file.is_regular_file(error)) bytes += file.file_size(error);
  return bytes;
}

std::string levels_text(const golden::GoldenSpec& spec) {
  std::string out;
  for (const EnumName<golden::Level>& w : kEnumNames<golden::Level>)
    if (spec.compares(w.value)) out.append(out.empty() ? "" : ", ").append(w.name);
  return out;
}

int run_list(const GoldenOptions& o) {
  std::uintmax_t all = 0;
  const std::vector<std::string> names = golden::golden_names(o.goldens);
  for (const std::string& name : names) {
    const golden::GoldenSpec spec = golden::read_golden_spec(o.goldens, name);
    const std::uintmax_t bytes = bytes_in((std::filesystem::path(o.goldens) / name).string());
    all += bytes;
    std::string missing;  // why its scenario cannot be opened
    try {
      golden::golden_source(o.goldens, name, spec);
    } catch (const InputError& e) {
      missing = e.what();
    }
    if (o.json)
      print(one_line(
          {{"golden", name},
           {"scenario", spec.scenario},
           {"compare", levels_text(spec)},
           {"size", {spec.width, spec.height}},
           {"frames", spec.frames},
           {"bytes", bytes},
           {"missing", missing.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(missing)}}));
    else
      print(name + ": " + spec.scenario + "; compares " + levels_text(spec) + "; up to " +
            std::to_string(spec.frames) + " pictures of " + std::to_string(spec.width) + "x" +
            std::to_string(spec.height) + "; " + std::to_string((bytes + 1023) / 1024) + " KiB\n" +
            (missing.empty() ? "" : "      its scenario cannot be opened: " + missing + "\n"));
  }
  if (!o.json)
    print(render::counted(names.size(), "golden", "goldens") + ", " + std::to_string((all + 1023) / 1024) +
          " KiB\n");
  return kOk;
}

/// Throws InputError if the golden belongs to another scenario that still exists: two scenarios of one name
/// would overwrite each other's folder.
void reject_another(const GoldenOptions& o, const std::string& name, const golden::GoldenSpec& kept,
                    const std::string& reference, const std::string& word) {
  if (kept.scenario == reference) return;
  try {
    golden::golden_source(o.goldens, name, kept);
  } catch (const InputError&) {
    return;  // it was removed or renamed
  }
  const std::filesystem::path folder = std::filesystem::path(o.goldens) / name;
  throw InputError(printable_name(word) + ": has the same name as another scenario, whose golden is in " +
                   printable_name(folder.string()) + " (its \"scenario\" is " + kept.scenario +
                   "); rename one of them, or approve into another folder with --goldens");
}

golden::GoldenSpec spec_to_approve(const GoldenOptions& o, const std::string& name,
                                   const golden::Source& source, const std::string& word) {
  golden::GoldenSpec spec;
  if (golden::has_golden(o.goldens, name)) {
    spec = golden::read_golden_spec(o.goldens, name);
    if (name != word) {
      const std::string reference = golden::scenario_reference(o.goldens, name, word);
      reject_another(o, name, spec, reference, word);
      spec.scenario = reference;
    }
  } else {
    golden::set_default_size(spec, golden::frames_of(source));
    spec.scenario = golden::scenario_reference(o.goldens, name, word);
  }
  if (!o.size.empty()) {
    PictureOptions picture;
    picture.size = o.size;
    pictures::FrameSpec frames;
    apply(picture, frames);
    spec.width = frames.width;
    spec.height = frames.height;
  }
  if (o.frames) spec.frames = *o.frames;
  apply(o, spec);
  return spec;
}

/// Returns why a golden should not be approved unless it is named: its scenario cannot be opened, or a file
/// of it is damaged. Returns an empty text if nothing is wrong.
std::string why_not_approved(const GoldenOptions& o, const std::string& name) {
  try {
    const golden::Golden golden = golden::load_golden(o.goldens, name);
    for (const auto& variants : golden.frames)
      for (const golden::GoldenImage& image : variants)
        if (!image.damage.empty()) return image.damage + "; to replace it: " + approve_command(o, name);
  } catch (const InputError& e) {
    return std::string(e.what()) + "; to replace it: " + approve_command(o, name);
  }
  try {
    golden::golden_source(o.goldens, name, golden::read_golden_spec(o.goldens, name));
  } catch (const InputError& e) {
    return std::string(e.what()) + "; to remove the golden: lrbscope golden remove --goldens " +
           shell_word(o.goldens) + " " + name;
  }
  return {};
}

int run_approve(const GoldenOptions& o, const Globals& globals) {
  if (!o.from.empty()) {
    for (const std::string& line : golden::approve_from(o.goldens, o.from, o.scenarios, o.dry))
      print(line + "\n");
    return kOk;
  }
  const std::vector<std::string> words = o.scenarios.empty() ? golden::golden_names(o.goldens) : o.scenarios;
  int code = kOk;
  for (const std::string& word : words) {
    if (o.scenarios.empty())
      if (const std::string why = why_not_approved(o, word); !why.empty()) {
        print("not approved: " + word + ": " + why + "\n");
        code = kMismatch;
        continue;
      }
    const golden::Source source =
        golden::has_golden(o.goldens, word)
            ? golden::golden_source(o.goldens, word, golden::read_golden_spec(o.goldens, word))
            : golden::open_source(word);
    const std::string name = golden::name_of(source);
    const golden::GoldenSpec spec = spec_to_approve(o, name, source, word);
    golden::GoldenRun run = golden::play_golden(source, spec, progress_report(globals.quiet));
    run.text = golden::scenario_text(o.goldens, name, spec);
    const std::vector<std::string> done = o.variant.empty()
                                              ? golden::approve_golden(o.goldens, spec, run, o.dry)
                                              : golden::approve_variant(o.goldens, run, o.variant, o.dry);
    for (const std::string& line : done) print(line + "\n");
    if (done.empty()) print("unchanged " + name + "\n");
  }
  return code;
}

int run_remove(const GoldenOptions& o) {
  for (const std::string& name : o.scenarios)
    if (!golden::has_golden(o.goldens, name))
      throw InputError(printable_name(name) + ": no golden of this name in " + printable_name(o.goldens) +
                       "; nothing was removed");
  for (const std::string& name : o.scenarios) {
    golden::remove_golden(o.goldens, name);
    print("removed " + name + "\n");
  }
  return kOk;
}

void add_folder(App& app, const std::shared_ptr<GoldenOptions>& o) {
  app.add_option("--goldens", o->goldens, "DIR", "Folder with the goldens")->capture_default_str();
}

App* add_part(App& golden, const std::string& name, const std::string& what,
              const std::shared_ptr<GoldenOptions>& o, const std::string& none) {
  App* app = golden.add_subcommand(name, what);
  app->add_option("SCENARIO", o->scenarios, "Shipped scenarios, JSON files, or captures [" + none + "]");
  add_folder(*app, o);
  return app;
}

/// Comparison options: for a call of test, or stored by approve.
void add_comparison(App& app, const std::shared_ptr<GoldenOptions>& o) {
  std::vector<std::string> words;
  for (const EnumName<golden::Level>& w : kEnumNames<golden::Level>) words.emplace_back(w.name);
  app.add_option_function<std::vector<std::string>>(
         "--compare",
         [o](const std::vector<std::string>& chosen) {
           for (const std::string& word : chosen) o->levels.push_back(from_name<golden::Level>(word).value());
         },
         all_names<golden::Level>(",", ","),
         "Parts to compare, comma-separated: answers, events, pictures, work [all, or as stored in the golden]")
      ->delimiter(',')
      ->allow_extra_args(false)  // scenarios may follow
      ->one_of(words);
  app.add_option("--picture-tolerance", o->large_share, "SHARE",
                 "Fraction of pixels allowed to differ strongly [0.0005, or as stored in the golden]")
      ->in_range(0.0, 1.0);
  app.add_option(
         "--work-tolerance", o->work, "SHARE",
         "Share by which tests and visited nodes of all steps may increase [0.05, or as stored in the golden]")
      ->in_range(0.0, 1e6);
}

void add_output(App& app, const std::shared_ptr<GoldenOptions>& o) {
  add_comparison(app, o);
  app.add_option("--junit", o->junit, "FILE", "Also write the results as JUnit XML");
  app.add_option("--markdown", o->markdown, "FILE",
                 "Also write the results as a Markdown table, for the summary of a CI job");
  app.add_option("--picture-url", o->picture_url, "URL",
                 "Address of the output folder, for the pictures of --markdown [its relative path]");
  app.add_option("--repeat", o->repeat, "N",
                 "Repeat a failed test N times, to distinguish a changed scenario from a flaky one")
      ->in_range(1, 1000);
  app.add_option("--jobs", o->jobs, "N",
                 "Number of scenarios to run in parallel; the result does not depend on it")
      ->in_range(1, 256)
      ->capture_default_str();
  app.add_option("-o,--output", o->folder, "DIR", "Folder for the report page and the differing pictures")
      ->capture_default_str();
  app.add_flag("--json", o->json, "Print one JSON line per scenario");
}

}  // namespace

Command add_golden(App& root, const Globals& globals) {
  App* app = root.add_subcommand("golden", "Regression-test runs against approved traces and pictures");
  const auto o = std::make_shared<GoldenOptions>();
  app->require_subcommand(1);
  App* test =
      add_part(*app, "test",
               "Compare runs with the goldens; on a difference, write a report page and exit with code 1", o,
               "all goldens");
  add_output(*test, o);
  App* approve = add_part(*app, "approve", "Approve the current runs: they replace the goldens that differ",
                          o, "all goldens");
  approve->add_option("--variant", o->variant, "NAME",
                      "Store differing pictures next to the approved ones, as a variant of this name");
  approve->add_option("--size", o->size, "WxH",
                      "Picture size, in pixels [480 wide, with the scenario's aspect ratio]");
  approve
      ->add_option("--frames", o->frames, "N",
                   "Number of pictures, evenly spaced over the scenario's frames [3]")
      ->in_range(1, 1000);
  const auto rectangles = [&](const char* name, std::vector<std::string>& to, const char* what) {
    approve->add_option(name, to, "X,Y,W,H", what)->allow_extra_args(false);
  };
  rectangles("--ignore", o->ignore, "A rectangle of pixels that is not compared; repeatable");
  rectangles("--only", o->only,
             "A rectangle of pixels that is compared, instead of whole pictures; repeatable");
  approve->add_option(
      "--from", o->from, "DIR",
      "Approve what a test found, on this machine or another one, instead of running the scenarios: its "
      "output folder");
  approve->add_flag("--dry-run", o->dry, "Change nothing; print which files would be approved or removed");
  add_comparison(*approve, o);
  // Results of a test are approved as they were drawn and compared there.
  for (const Option& option : approve->options())
    if (const std::string name = option.name();
        name != "--from" && name != "--goldens" && name != "--dry-run" && !option.is_argument())
      approve->get_option("--from")->excludes(&option);
  App* remove = app->add_subcommand("remove", "Remove goldens: the files that approving wrote");
  remove->add_option("NAME", o->scenarios, "Goldens, by name")->required();
  add_folder(*remove, o);
  App* list = app->add_subcommand("list", "List the goldens, how each is compared, and their size on disk");
  add_folder(*list, o);
  list->add_flag("--json", o->json, "Print one JSON line per golden");
  App* report = add_part(*app, "report", "Like test, but always write a report page with every picture", o,
                         "all goldens");
  add_output(*report, o);
  return {app, [o, &globals, test, report, list, remove] {
            if (list->parsed()) return run_list(*o);
            if (remove->parsed()) return run_remove(*o);
            if (test->parsed()) return run_test(*o, globals, false);
            if (report->parsed()) return run_test(*o, globals, true);
            return run_approve(*o, globals);
          }};
}

}  // namespace lrb::tools
