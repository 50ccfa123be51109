#include "scenarios/golden/golden.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "scenarios/io/files.hpp"
#include "scenarios/profile/captured_run.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::golden {
namespace {

std::string counts_of(const Mesh& m) {
  return render::group_digits(m.vertices.size()) + " vertices and " + render::group_digits(m.face_count()) +
         " faces";
}

double diagonal_of(const Mesh& m) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : m.vertices) box.extend(v);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

std::size_t other_faces(const Mesh& x, const Mesh& y) {
  std::size_t count = 0;
  for (std::uint32_t f = 0; f < x.face_count(); ++f) {
    const auto p = x.face(FaceId(f)), q = y.face(FaceId(f));
    count += !std::equal(p.begin(), p.end(), q.begin(), q.end());
  }
  return count;
}

}  // namespace

std::uint64_t mesh_hash(const Mesh& mesh) {
  Fnv64 hash;
  hash.add_value(mesh.dim);
  for (const Eigen::Vector3d& v : mesh.vertices) hash.add_bytes(v.data(), 3 * sizeof(double));
  hash.add_array(mesh.face_offsets);
  hash.add_array(mesh.face_vertices);
  return hash.value();
}

std::string kept_file(std::size_t body, int dim) {
  return std::string(1, static_cast<char>('a' + body)) + (dim == 2 ? ".obj" : ".ply");
}

std::string mesh_difference(const Mesh& x, const Mesh& y, std::optional<std::size_t>* farthest_out) {
  if (x.vertices.size() != y.vertices.size() || x.face_count() != y.face_count())
    return counts_of(x) + " -> " + counts_of(y);
  std::size_t moved = 0, farthest = 0;
  double most = 0;
  for (std::size_t v = 0; v < x.vertices.size(); ++v) {
    if (x.vertices[v] == y.vertices[v]) continue;
    const double by = (y.vertices[v] - x.vertices[v]).norm();
    if (moved++ == 0 || by > most) farthest = v, most = by;
  }
  const std::size_t faces = other_faces(x, y);
  if (moved == 0 && faces == 0) return {};
  std::string out;
  if (moved > 0) {
    if (farthest_out != nullptr) *farthest_out = farthest;
    const double share = 100 * most / diagonal_of(x);
    out = (moved == 1 ? "vertex "
                      : render::group_digits(moved) + " vertices moved; largest displacement: vertex ") +
          std::to_string(farthest) + (moved == 1 ? " moved by " : " by ") + render::short_number(most) +
          " (" + render::short_number(share) + " % of the body's diagonal)";
  }
  if (faces > 0)
    out += (out.empty() ? "" : "; ") + render::group_digits(faces) +
           (faces == 1 ? " face has different corners" : " faces have different corners");
  return out;
}

std::string compact_json(const std::string& text) {
  return nlohmann::json::parse(text, nullptr, false, true).dump();
}

namespace {

/// Appends the differing values of two JSON values. Arrays of numbers are values; other arrays of one length
/// and objects are searched.
void differing_keys(const nlohmann::json& x, const nlohmann::json& y, const std::string& at,
                    std::vector<std::string>& out) {
  if (x == y) return;
  const auto nested = [](const nlohmann::json& j) {
    return j.is_array() &&
           std::any_of(j.begin(), j.end(), [](const auto& item) { return item.is_structured(); });
  };
  if (x.is_object() && y.is_object()) {
    const std::string before = at.empty() ? "" : at + ".";
    static const nlohmann::json absent(nlohmann::json::value_t::discarded);
    for (const auto& [key, value] : x.items())
      differing_keys(value, y.contains(key) ? y[key] : absent, before + key, out);
    for (const auto& [key, value] : y.items())
      if (!x.contains(key)) differing_keys(absent, value, before + key, out);
    return;
  }
  if (nested(x) && nested(y) && x.size() == y.size()) {
    for (std::size_t i = 0; i < x.size(); ++i)
      differing_keys(x[i], y[i], at + "[" + std::to_string(i) + "]", out);
    return;
  }
  const auto value = [](const nlohmann::json& j) {
    constexpr std::size_t kLongest = 80;
    if (j.is_discarded()) return std::string("absent");
    const std::string text = j.dump();
    return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
  };
  out.push_back(at + ": " + value(x) + " -> " + value(y));
}

}  // namespace

std::string scenario_difference(const std::string& expected, const std::string& found) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> keys;
  differing_keys(nlohmann::json::parse(expected, nullptr, false),
                 nlohmann::json::parse(found, nullptr, false), {}, keys);
  std::string out;
  for (std::size_t i = 0; i < std::min(keys.size(), kMost); ++i)
    out.append(i == 0 ? "" : "; ").append(keys[i]);
  if (keys.size() > kMost) out += "; and " + std::to_string(keys.size() - kMost) + " more";
  return out;
}

namespace fs = std::filesystem;
namespace {

constexpr std::string_view kFrame = "frame_", kPng = ".png";
constexpr std::uint64_t kMaxFrames = 1000;
constexpr double kLongest = 1e308;  // maximum length of a contact
constexpr double kMaxWorkTolerance = 1e6;

std::string folder_of(const std::string& goldens, const std::string& name) {
  return (fs::path(goldens) / name).string();
}

/// Returns 11 for "frame_12.png" and "frame_12.variant.png", or nullopt for other names.
std::optional<std::size_t> frame_of_file(std::string_view file) {
  if (!file.starts_with(kFrame) || !file.ends_with(kPng)) return std::nullopt;
  const char *first = file.data() + kFrame.size(), *last = file.data() + file.size();
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(first, last, number);
  if (error != std::errc() || number == 0 || *end != '.') return std::nullopt;
  return number - 1;
}

template <class Wanted>
std::vector<std::string> image_files(const std::string& folder, const Wanted& wanted) {
  std::vector<std::string> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string file = entry.path().filename().string();
    if (const auto frame = frame_of_file(file); frame && wanted(*frame)) out.push_back(file);
  }
  // The file without a variant has the shortest name of its frame.
  std::sort(out.begin(), out.end(), [](const std::string& x, const std::string& y) {
    return x.size() != y.size() ? x.size() < y.size() : x < y;
  });
  return out;
}

/// Reads a picture of a golden. Keeps a damaged one with the reason: it is reported as a failure, and the
/// others are still tested.
GoldenImage read_image(const std::string& folder, const std::string& file, const GoldenSpec& spec) {
  constexpr std::uint64_t kLarger = 4;  // times the pixels in golden.json: a picture of another size is an
                                        // ordinary difference
  const auto expected = static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  GoldenImage image{file, {}, {}};
  try {
    image.png = render::read_png(folder + "/" + file, kLarger * expected);
  } catch (const InputError& e) {
    image.damage = e.what();
  }
  return image;
}

void read_tolerance(const io::JsonNode& node, GoldenSpec& spec) {
  node.object({"large", "large_share", "small_share", "work"});
  render::ImageTolerance& t = spec.tolerance;
  if (const auto n = node.get("large")) t.large = static_cast<int>(n->integer(1, 255));
  if (const auto n = node.get("large_share")) t.large_share = n->number(0, 1);
  if (const auto n = node.get("small_share")) t.small_share = n->number(0, 1);
  if (const auto n = node.get("work")) spec.work = n->number(0, kMaxWorkTolerance);
}

std::vector<render::PixelRect> read_rectangles(const io::JsonNode& node) {
  std::vector<render::PixelRect> out;
  for (const io::JsonNode& item : node.items()) {
    const std::vector<io::JsonNode> n = item.items();
    if (n.size() != 4) item.fail("expected [x, y, width, height] in pixels");
    const auto pixels = [](const io::JsonNode& x, int least) {
      return static_cast<int>(x.integer(least, render::Image::kMaxSide));
    };
    out.push_back({pixels(n[0], 0), pixels(n[1], 0), pixels(n[2], 1), pixels(n[3], 1)});
  }
  return out;
}

nlohmann::ordered_json rectangles_json(const std::vector<render::PixelRect>& rectangles) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const render::PixelRect& r : rectangles) out.push_back({r.x, r.y, r.width, r.height});
  return out;
}

std::string spec_file(const std::string& goldens, const std::string& name) {
  return (fs::path(goldens) / name / kGoldenSpec).string();
}

GoldenSpec read_spec(const io::JsonNode& root) {
  root.object({"scenario", "size", "frames", "compare", "tolerance", "ignore", "only", "meshes",
               "contact_lengths", "renderer", "inputs"});
  GoldenSpec spec;
  spec.scenario = root.at("scenario").string();
  const std::vector<io::JsonNode> size = root.at("size").items();
  if (size.size() != 2) root.at("size").fail("expected [width, height]");
  spec.width = static_cast<int>(size[0].integer(64, 8192));
  spec.height = static_cast<int>(size[1].integer(64, 8192));
  spec.frames = static_cast<std::uint32_t>(root.at("frames").integer(1, kMaxFrames));
  if (const auto n = root.get("compare")) {
    spec.levels = {};
    for (const io::JsonNode& word : n->items(1))
      spec.levels[static_cast<std::size_t>(word.choice<Level>())] = true;
  }
  if (const auto n = root.get("tolerance")) read_tolerance(*n, spec);
  if (const auto n = root.get("ignore")) spec.ignore = read_rectangles(*n);
  if (const auto n = root.get("only")) spec.only = read_rectangles(*n);
  return spec;
}

GoldenFacts read_facts(const io::JsonNode& root) {
  GoldenFacts facts;
  if (const auto n = root.get("renderer")) facts.renderer = n->string();
  if (const auto n = root.get("inputs")) {
    if (!n->is_object()) n->fail("expected the JSON of a scenario");
    facts.scenario = n->json().dump();
  }
  if (const auto n = root.get("meshes"))
    for (const io::JsonNode& word : n->items()) {
      const auto hash = trace::from_hex(word.string());
      if (!hash) word.fail("expected 16 lower-case hexadecimal digits");
      facts.meshes.push_back(*hash);
    }
  if (const auto n = root.get("contact_lengths"))
    for (const io::JsonNode& length : n->items()) facts.contact_lengths.push_back(length.number(0, kLongest));
  return facts;
}

/// Reads the kept meshes of the bodies. A missing or damaged one only makes the description of a difference
/// less specific.
std::vector<std::optional<Mesh>> read_meshes(const std::string& folder,
                                             const std::vector<trace::BodyInfo>& bodies) {
  std::vector<std::optional<Mesh>> out;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string file = folder + "/" + kept_file(i, static_cast<int>(bodies[i].dim));
    std::error_code error;
    out.emplace_back();
    if (!fs::exists(file, error)) continue;
    try {
      out.back() = read_mesh(file);
    } catch (const InputError&) {
    }
  }
  return out;
}

}  // namespace

std::string golden_image_file(std::size_t frame, const std::string& variant) {
  return std::string(kFrame) + std::to_string(frame + 1) + (variant.empty() ? "" : "." + variant) +
         std::string(kPng);
}

std::vector<std::string> image_files_of(const std::string& folder, std::size_t frame) {
  return image_files(folder, [frame](std::size_t f) { return f == frame; });
}

std::vector<std::string> image_files_from(const std::string& folder, std::size_t first_frame) {
  return image_files(folder, [first_frame](std::size_t f) { return f >= first_frame; });
}

bool has_golden(const std::string& goldens, const std::string& name) {
  std::error_code error;
  return !name.empty() && name.find('/') == std::string::npos &&
         fs::is_regular_file(fs::path(goldens) / name / kGoldenSpec, error);
}

std::vector<std::string> golden_names(const std::string& goldens) {
  std::vector<std::string> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(goldens, error))
    if (has_golden(goldens, entry.path().filename().string()))
      out.push_back(entry.path().filename().string());
  if (out.empty())
    throw InputError(printable_name(goldens) +
                     ": no goldens found; create them with lrbscope golden approve SCENARIO, or choose "
                     "another folder with --goldens");
  std::sort(out.begin(), out.end());
  return out;
}

GoldenSpec read_golden_spec(const std::string& goldens, const std::string& name) {
  const std::string file = spec_file(goldens, name);
  const io::JsonText json(io::read_small_text(file), file);
  return read_spec(io::JsonNode(json));
}

void write_golden_spec(const std::string& goldens, const std::string& name, const GoldenSpec& spec,
                       const GoldenFacts& facts) {
  nlohmann::ordered_json json = {
      {"scenario", spec.scenario}, {"size", {spec.width, spec.height}}, {"frames", spec.frames}};
  if (spec.levels != GoldenSpec{}.levels) {
    json["compare"] = nlohmann::ordered_json::array();
    for (const EnumName<Level>& w : kEnumNames<Level>)
      if (spec.compares(w.value)) json["compare"].push_back(w.name);
  }
  const GoldenSpec usual;
  if (!(spec.tolerance == usual.tolerance))
    json["tolerance"] = {{"large", spec.tolerance.large},
                         {"large_share", spec.tolerance.large_share},
                         {"small_share", spec.tolerance.small_share}};
  if (spec.work != usual.work) json["tolerance"]["work"] = spec.work;
  if (!spec.ignore.empty()) json["ignore"] = rectangles_json(spec.ignore);
  if (!spec.only.empty()) json["only"] = rectangles_json(spec.only);
  for (const std::uint64_t hash : facts.meshes) json["meshes"].push_back(trace::to_hex(hash));
  for (const double length : facts.contact_lengths) json["contact_lengths"].push_back(length);
  if (!facts.renderer.empty()) json["renderer"] = facts.renderer;
  if (!facts.scenario.empty()) json["inputs"] = nlohmann::json::parse(facts.scenario);
  io::write_text(spec_file(goldens, name), json.dump() + "\n");
}

std::string scenario_reference(const std::string& goldens, const std::string& name,
                               const std::string& name_or_path) {
  if (name_or_path == name) return name_or_path;  // files end in .json, names never do
  std::error_code error;
  const fs::path from = fs::absolute(fs::path(goldens) / name, error).lexically_normal();
  return fs::absolute(name_or_path, error).lexically_normal().lexically_relative(from).generic_string();
}

Source open_source(const std::string& name_or_path) {
  if (name_or_path.ends_with(kCaptureEnding)) {
    std::error_code error;
    if (!fs::is_regular_file(name_or_path, error))
      throw InputError(printable_name(name_or_path) +
                       ": no such file; record it again: LRBCAP_OUT=" + printable_name(name_or_path));
    return CapturedQueries{fs::path(name_or_path).stem().string(), name_or_path, profile::captured_frames()};
  }
  return spec::open_scenario(name_or_path);
}

const std::string& name_of(const Source& source) {
  return std::visit([](const auto& s) -> const std::string& { return s.name; }, source);
}

const pictures::FrameSpec& frames_of(const Source& source) {
  return std::visit([](const auto& s) -> const pictures::FrameSpec& { return s.frames; }, source);
}

namespace {

/// Returns the name of a shipped scenario, or a path from the current folder.
std::string scenario_of(const std::string& goldens, const std::string& name, const GoldenSpec& spec) {
  const bool shipped = spec.scenario.find_first_of("./\\") == std::string::npos;
  return shipped ? spec.scenario : (fs::path(goldens) / name / spec.scenario).lexically_normal().string();
}

}  // namespace

std::string scenario_text(const std::string& goldens, const std::string& name, const GoldenSpec& spec) {
  if (spec.is_capture()) return {};
  return spec::open_named(scenario_of(goldens, name, spec), spec::kScenarioEnding, "scenario").text;
}

Source golden_source(const std::string& goldens, const std::string& name, const GoldenSpec& spec) {
  const std::string file = scenario_of(goldens, name, spec);
  Source source = open_source(file);
  if (name_of(source) != name)
    throw InputError(printable_name(folder_of(goldens, name)) + ": " + kGoldenSpec + " refers to a " +
                     (spec.is_capture() ? "capture" : "scenario") + " with the name " + name_of(source) +
                     "; rename the folder, or remove it and approve the scenario again");
  return source;
}

Golden load_golden(const std::string& goldens, const std::string& name) {
  Golden golden;
  golden.name = name;
  const std::string about = spec_file(goldens, name), folder = folder_of(goldens, name);
  const io::JsonText json(io::read_small_text(about), about);
  golden.spec = read_spec(io::JsonNode(json));
  golden.facts = read_facts(io::JsonNode(json));
  golden.trace = trace::load_trace(folder + "/" + kGoldenTrace);
  golden.meshes = read_meshes(folder, golden.trace.header.bodies);
  for (const std::string& image : image_files_from(folder, 0)) {
    const std::size_t frame = *frame_of_file(image);
    if (frame >= kMaxFrames) continue;
    if (golden.frames.size() <= frame) golden.frames.resize(frame + 1);
    golden.frames[frame].push_back(read_image(folder, image, golden.spec));
  }
  return golden;
}

void remove_golden(const std::string& goldens, const std::string& name) {
  if (!has_golden(goldens, name))
    throw InputError(printable_name(name) + ": no golden of this name in " + printable_name(goldens));
  const std::string folder = (fs::path(goldens) / name).string();
  std::vector<std::string> files = image_files_from(folder, 0);
  for (const int dim : {2, 3})
    for (const std::size_t body : {0, 1}) files.push_back(kept_file(body, dim));
  files.push_back(kGoldenTrace);
  files.push_back(kGoldenSpec);  // last: until then it can be tried again
  for (const std::string& file : files) fs::remove(fs::path(folder) / file);
  std::error_code not_empty;  // it then has files of the user
  fs::remove(folder, not_empty);
}

}  // namespace lrb::golden
