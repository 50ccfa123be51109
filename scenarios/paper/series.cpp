#include "scenarios/paper/series.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include <nlohmann/json.hpp>

#include "engine/mesh/io/formats.hpp"
#include "scenarios/bodies/generators.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/trace/json_write.hpp>

namespace lrb::resolutions {

PowerFit fit_power(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / n;
    mean_y += std::log(y[i]) / n;
  }
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x, dy = std::log(y[i]) - mean_y;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  PowerFit fit;
  fit.exponent = xy / xx;
  fit.factor = std::exp(mean_y - fit.exponent * mean_x);
  if (x.size() > 2) fit.error = std::sqrt(std::max(0.0, yy - fit.exponent * xy) / (n - 2) / xx);
  return fit;
}

}  // namespace lrb::resolutions

namespace lrb::paper {
namespace {

namespace fs = std::filesystem;

/// Returns the meshes in a folder, by name; other paths unchanged.
std::vector<std::string> files_of(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code failure;
    if (!fs::is_directory(path, failure)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(path, failure))
      if (has_mesh_extension(entry.path().string())) found.push_back(entry.path().string());
    if (failure) throw InputError(printable_name(path) + ": cannot read the file: " + failure.message());
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// Returns the reason why no series can be made of a mesh; empty if one can.
std::string obstacle(const Mesh& mesh) {
  if (mesh.dim != 3) return "a 2D body";
  const MeshReport report = check_mesh(mesh, false).when_turned();
  return report.buildable() ? "" : "an LRB-rep cannot be built (see `lrbscope inspect`)";
}

auto key(const ContactStep& s) {
  return std::tie(s.object, s.collision, s.step);
}

}  // namespace

std::string series_name(const SeriesObject& object, SeriesPartner partner) {
  return object.body + "/" + std::to_string(object.rep.real_face_count()) +
         (partner == SeriesPartner::a ? "/A" : "/itself");
}

std::vector<Mesh> own_series_bodies() {
  std::vector<Mesh> bodies = {generators::generate("rock", {{"frequency", 64}}),
                              generators::generate("knot", {{"segments", 1600}, {"sides", 24}})};
  bodies[0].name = "rock";
  bodies[1].name = "knot";
  return bodies;
}

std::vector<Mesh> read_series_bodies(const std::vector<std::string>& paths, std::vector<std::string>& notes) {
  std::vector<Mesh> bodies;
  std::set<std::string> names;
  for (const std::string& file : files_of(paths)) {
    Mesh mesh = read_mesh(file);
    mesh.name = fs::path(file).stem().string();
    if (const std::string why = obstacle(mesh); !why.empty()) {
      notes.push_back(printable_name(file) + ": skipped: " + why);
      continue;
    }
    if (!names.insert(mesh.name).second)
      throw InputError(printable_name(file) + ": another mesh has the name " + printable_name(mesh.name) +
                       "; give each mesh its own name");
    bodies.push_back(std::move(mesh));
  }
  if (bodies.empty())
    throw InputError(
        "--meshes: no mesh from which an LRB-rep can be built; give OBJ, PLY, STL or OFF files of closed "
        "bodies, or folders of them");
  return bodies;
}

std::vector<SeriesObject> make_series(std::span<const Mesh> bodies,
                                      const resolutions::ResolutionOptions& options,
                                      const BuildOptions& building, double diagonal_of_a,
                                      const std::function<void(const LrbRep&)>& progress) {
  std::vector<SeriesObject> objects;
  for (const Mesh& body : bodies) {
    for (const Mesh& mesh : resolutions::resolutions(body, options)) {
      const LrbRep rep = build_lrb(mesh, building);
      objects.push_back({body.name, scaled(rep, diagonal_of_a / diagonal(rep))});
      if (progress) progress(objects.back().rep);
    }
  }
  return objects;
}

std::vector<ContactStep> run_series(const LrbRep& a, std::span<const SeriesObject> objects,
                                    const SweepOptions& options) {
  std::vector<ContactStep> steps;
  for (const SeriesPartner partner : kSeriesPartners)
    for (const SeriesObject& object : objects) {
      const PaperObject pair[] = {{"", partner == SeriesPartner::a ? a : object.rep},
                                  {series_name(object, partner), object.rep, object.body}};
      for (ContactStep& s : run_sweep(pair, options)) steps.push_back(std::move(s));
    }
  return merged(std::move(steps));
}

std::string times_to_json_lines(std::span<const ContactStep> steps) {
  std::string out;
  for (const ContactStep& s : steps) {
    const nlohmann::ordered_json line = {
        {"object", s.object},
        {"collision", s.collision},
        {"step", s.step},
        {"nanoseconds", {s.counts[0].nanoseconds, s.counts[1].nanoseconds, s.counts[2].nanoseconds}}};
    out += line.dump() + "\n";
  }
  return out;
}

void read_times(const std::string& text, const std::string& file, std::vector<ContactStep>& steps) {
  const auto reject = [&](std::size_t line, const std::string& why) {
    throw InputError(printable_name(file) + ":" + std::to_string(line) + ": " + why +
                     "; give the output folders of the shards of one `lrbscope paper`");
  };
  std::map<std::tuple<std::string, std::uint32_t, std::uint32_t>, ContactStep*> by_key;
  for (ContactStep& s : steps) by_key[key(s)] = &s;
  std::size_t number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    try {
      const auto j = nlohmann::json::parse(text.substr(begin, end - begin));
      const auto found =
          by_key.find({j.at("object").get<std::string>(), j.at("collision").get<std::uint32_t>(),
                       j.at("step").get<std::uint32_t>()});
      const auto ns = j.at("nanoseconds").get<std::array<std::uint64_t, 3>>();
      if (found == by_key.end()) reject(number, "a time for a step without a record");
      for (std::size_t i = 0; i < ns.size(); ++i) found->second->counts[i].nanoseconds = ns[i];
    } catch (const nlohmann::json::exception& e) {
      reject(number, "not the time of a step: " + printable_name(e.what()));
    }
    begin = end + 1;
  }
}

std::vector<SeriesRow> series_rows(const LrbRep& a, std::span<const SeriesObject> objects,
                                   std::span<const ContactStep> steps) {
  std::vector<SeriesRow> rows;
  std::map<std::string, std::vector<ContactStep>> by_object;
  for (const ContactStep& s : steps) by_object[s.object].push_back(s);
  for (const SeriesPartner partner : kSeriesPartners) {
    for (const SeriesObject& object : objects) {
      const std::string name = series_name(object, partner);
      const std::vector<ContactStep> own = std::move(by_object[name]);
      by_object.erase(name);
      const PaperObject pair[] = {{"", partner == SeriesPartner::a ? a : object.rep}, {name, object.rep}};
      SeriesRow row{object.body, partner, object.rep.outermost_faces().size(), make_table(pair, own)[0], {}};
      for (std::size_t i = 0; i < kRecursions.size(); ++i) {
        std::vector<double> microseconds;
        for (const ContactStep& s : own)
          microseconds.push_back(static_cast<double>(s.counts[i].nanoseconds) / 1000);
        row.microseconds[i] = band_of(std::move(microseconds)).median;
      }
      rows.push_back(std::move(row));
    }
  }
  if (!by_object.empty())
    throw InputError(
        "the records contain the object " + printable_name(by_object.begin()->first) +
        ", which is not in the series; give the same --meshes, --resolutions and --subdivide as for the "
        "shards");
  return rows;
}

}  // namespace lrb::paper
