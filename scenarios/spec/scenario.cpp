#include "scenarios/spec/scenario.hpp"

#include <algorithm>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "scenarios/io/files.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/record_fields.hpp>

namespace lrb::spec {
namespace {

constexpr std::uint64_t kMaxFrames = 10'000;

FrameSpec::View read_view(const io::JsonNode& node) {
  using Camera = FrameSpec::Camera;
  node.object({"camera", "projection", "eye", "target", "from", "up", "look_at", "turn_degrees", "zoom",
               "draw", "title"});
  FrameSpec::View v;
  if (const auto n = node.get("camera")) v.camera = n->choice<Camera>();
  if (const auto n = node.get("projection"))
    v.orthographic = n->choice<bool>({{"perspective", false}, {"orthographic", true}});
  if ((v.camera == Camera::fixed) != (node.has("eye") && node.has("target")))
    node.fail("\"eye\" and \"target\" are required for a fixed camera, and not allowed for others");
  if (const auto n = node.get("eye")) v.eye = n->vector();
  if (const auto n = node.get("target")) v.target = n->vector();
  if (const auto n = node.get("from")) v.from = n->vector();
  if (const auto n = node.get("up")) v.up = n->vector();
  if (const auto n = node.get("look_at")) v.look_at = n->vector();
  if (const auto n = node.get("turn_degrees")) v.turn_degrees = n->number(-36000, 36000);
  if (const auto n = node.get("zoom")) v.zoom = n->number(0.01, 1000);
  if (const auto n = node.get("draw")) v.wrapper = n->choice<bool>({{"wrapper", true}, {"body", false}});
  if (const auto n = node.get("title")) v.title = n->string();
  if (!(v.from.cross(v.up).squaredNorm() > 0)) node.fail("\"from\" and \"up\" must not be parallel");
  return v;
}

void read_moments(const io::JsonNode& node, FrameSpec& f) {
  using At = FrameSpec::At;
  if (const auto n = node.get("at")) f.at = n->choice<At>();
  if (const auto n = node.get("every")) f.every = static_cast<std::uint32_t>(n->integer(1, kMaxId));
  if (const auto n = node.get("events")) {
    if (node.has("at") || node.has("every"))
      node.fail_key("events", "a list of events replaces \"at\" and \"every\"; remove them");
    f.at = At::events;
    for (const io::JsonNode& item : n->items(1))
      f.events.push_back(static_cast<std::uint32_t>(item.integer(0, kMaxId)));
  }
  if (const auto n = node.get("most")) f.most = static_cast<std::uint32_t>(n->integer(1, kMaxFrames));
}

nlohmann::json to_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

nlohmann::json to_json(const FrameSpec::View& v) {
  nlohmann::json j;
  j["camera"] = name_of(v.camera);
  j["projection"] = v.orthographic ? "orthographic" : "perspective";
  if (v.camera == FrameSpec::Camera::fixed) {
    j["eye"] = to_json(v.eye);
    j["target"] = to_json(v.target);
  }
  j["from"] = to_json(v.from);
  j["up"] = to_json(v.up);
  if (v.look_at) j["look_at"] = to_json(*v.look_at);
  if (v.turn_degrees != 0) j["turn_degrees"] = v.turn_degrees;
  j["zoom"] = v.zoom;
  j["draw"] = v.wrapper ? "wrapper" : "body";
  if (!v.title.empty()) j["title"] = v.title;
  return j;
}

}  // namespace

FrameSpec default_frames(Show show) {
  FrameSpec f;
  f.at = show == Show::collision    ? FrameSpec::At::step
         : show == Show::refinement ? FrameSpec::At::refinement
                                    : FrameSpec::At::pass;
  if (show == Show::construction) f.colour_by = FrameSpec::ColourBy::region;
  return f;
}

std::string pictures_text(const FrameSpec& frames) {
  nlohmann::json j;
  j["size"] = {frames.width, frames.height};
  if (frames.dpi > 0) j["dpi"] = frames.dpi;
  if (frames.style != render::StyleName::screen) j["style"] = name_of(frames.style);
  for (const FrameSpec::View& v : frames.views) j["views"].push_back(to_json(v));
  if (frames.montage > 0) {
    j["montage"]["panels"] = frames.montage;
    if (frames.montage_columns > 0) j["montage"]["columns"] = frames.montage_columns;
  }
  return j.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

FrameSpec read_pictures(const std::string& text, const std::string& name, const FrameSpec& fallback) {
  if (text.empty()) return fallback;
  const io::JsonText json(text, name + ", pictures");
  return read_frames(io::JsonNode(json), fallback);
}

FrameSpec read_frames(const io::JsonNode& node, const FrameSpec& fallback) {
  node.object({"at", "every", "events", "most", "size", "dpi", "format", "supersampling", "colour_by",
               "colour_per", "views", "transparent", "style", "titles", "legend", "node_boxes", "explode",
               "montage"});
  FrameSpec f = fallback;
  read_moments(node, f);
  if (const auto n = node.get("size")) {
    const std::vector<io::JsonNode> size = n->items();
    if (size.size() != 2) n->fail("expected [width, height]");
    f.width = static_cast<int>(size[0].integer(64, 8192));
    f.height = static_cast<int>(size[1].integer(64, 8192));
  }
  if (const auto n = node.get("dpi")) f.dpi = n->number(kMinDpi, kMaxDpi);
  if (const auto n = node.get("format")) f.svg = n->choice<bool>({{"png", false}, {"svg", true}});
  if (const auto n = node.get("supersampling")) f.supersampling = static_cast<int>(n->integer(1, 4));
  if (const auto n = node.get("colour_by")) f.colour_by = n->choice<FrameSpec::ColourBy>();
  if (const auto n = node.get("colour_per")) f.colour_per = n->choice<FrameSpec::ColourPer>();
  if (const auto n = node.get("views"))
    for (const io::JsonNode& item : n->items(1)) f.views.push_back(read_view(item));
  if (f.views.size() > 6) node.at("views").fail("expected at most 6 views");
  if (const auto n = node.get("transparent")) f.transparent = n->boolean();
  if (const auto n = node.get("style")) f.style = n->choice<render::StyleName>();
  if (const auto n = node.get("titles")) f.titles = n->boolean();
  if (const auto n = node.get("legend")) f.legend = n->boolean();
  if (const auto n = node.get("node_boxes"))
    f.node_boxes = static_cast<std::uint32_t>(n->integer(0, kMaxDepth));
  if (const auto n = node.get("explode")) f.explode = n->number(0, 10);
  if (const auto n = node.get("montage")) {
    n->object({"panels", "columns"});
    f.montage = static_cast<std::uint32_t>(n->at("panels").integer(1, 26));
    if (const auto c = n->get("columns")) f.montage_columns = static_cast<std::uint32_t>(c->integer(1, 26));
  }
  return f;
}

namespace {

BuildOptions read_build(const io::JsonNode& node, std::uint64_t seed) {
  node.object({"patch_interior", "max_outer_faces", "max_lids", "merge_planes", "lean", "seed"});
  BuildOptions o;
  o.seed = seed;
  if (const auto n = node.get("patch_interior"))
    o.patch_interior = static_cast<std::uint32_t>(n->integer(1, 1000));
  if (const auto n = node.get("max_outer_faces"))
    o.max_outer_faces = static_cast<std::uint32_t>(n->integer(4, 1000));
  if (const auto n = node.get("max_lids")) o.max_lids = static_cast<std::uint32_t>(n->integer(0, 1000));
  if (const auto n = node.get("merge_planes")) o.merge_planes = n->boolean();
  if (const auto n = node.get("lean")) o.lean = n->boolean();
  if (const auto n = node.get("seed")) o.seed = n->integer(0, kAnySeed);
  if (o.merge_planes && o.lean) node.fail_key("merge_planes", "cannot merge planes in a lean LRB-rep");
  return o;
}

generators::GeneratorValues read_parameters(const io::JsonNode& node,
                                            const generators::Generator& generator) {
  std::vector<std::string> known;
  for (const generators::GeneratorParameter& p : generator.parameters) known.emplace_back(p.name);
  node.object(known);
  generators::GeneratorValues values;
  for (const generators::GeneratorParameter& p : generator.parameters) {
    const auto n = node.get(p.name);
    if (!n) continue;
    values[p.name] = p.whole ? static_cast<double>(n->integer(static_cast<std::uint64_t>(p.least),
                                                              static_cast<std::uint64_t>(p.most)))
                             : n->number(p.least, p.most);
  }
  return values;
}

}  // namespace

BodySpec read_body(const io::JsonNode& node, const std::filesystem::path& folder, std::uint64_t seed) {
  node.object({"file", "generator", "parameters", "build", "pose"});
  BodySpec body;
  body.build.seed = seed;
  if (node.has("file") == node.has("generator")) node.fail("expected either \"file\" or \"generator\"");
  if (const auto file = node.get("file")) {
    if (node.has("parameters")) node.fail_key("parameters", "only a generator has parameters; remove it");
    if (file->string().empty()) file->fail("expected the name of a mesh or .lrb file");
    body.file = (folder / file->string()).lexically_normal().string();
  } else {
    std::vector<std::pair<std::string, const generators::Generator*>> known;
    for (const generators::Generator& g : generators::generators()) known.emplace_back(g.name, &g);
    const generators::Generator* generator = node.at("generator").choice(known);
    body.generator = generator->name;
    if (const auto parameters = node.get("parameters"))
      body.parameters = read_parameters(*parameters, *generator);
  }
  if (const auto build = node.get("build")) {
    body.build = read_build(*build, seed);
    const generators::Generator* generator = generators::find_generator(body.generator);
    for (const char* key : {"patch_interior", "max_outer_faces", "max_lids", "merge_planes", "lean"})
      if (generator != nullptr && generator->make_rep != nullptr && build->has(key))
        build->fail_key(key, "the regions of this body are known by construction; remove it");
  }
  if (const auto pose = node.get("pose")) body.pose = read_pose(*pose);
  return body;
}

std::string read_name(const io::JsonNode& node) {
  const std::string name = node.string();
  const bool plain = !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!plain) node.fail("expected 1 to 64 letters, digits, - and _, because it also names the output folder");
  return name;
}

namespace {

constexpr double kLongestTolerance = 1e150;  // its square is still finite
constexpr std::uint64_t kMaxCount = std::uint64_t{1} << 62;

/// Reads a value of a query by its type: a length, a count of at least 1, a word, or true or false.
template <class Enum>
void read_value(const io::JsonNode& node, Enum& value) {
  value = node.choice<Enum>();
}
void read_value(const io::JsonNode& node, double& value) {
  value = node.number(0, kLongestTolerance);
}
void read_value(const io::JsonNode& node, std::uint64_t& value) {
  value = node.integer(1, kMaxCount);
}
void read_value(const io::JsonNode& node, bool& value) {
  value = node.boolean();
}

std::vector<BodySpec> read_bodies(const io::JsonNode& node, Show show, const std::filesystem::path& folder,
                                  std::uint64_t seed) {
  node.object({"a", "b"});
  std::vector<BodySpec> bodies = {read_body(node.at("a"), folder, seed)};
  if (show == Show::collision)
    bodies.push_back(read_body(node.at("b"), folder, seed));
  else if (node.has("b"))
    node.fail_key("b", "a scenario of a refinement or a construction has only body a; remove it");
  return bodies;
}

void read_trace(const io::JsonNode& node, Scenario& s) {
  node.object({"clock", "events", "max_events", "gzip"});
  if (const auto n = node.get("clock")) s.clock = n->choice<trace::Clock>();
  if (const auto n = node.get("events")) s.events = n->choice<EventLevel>();
  if (const auto n = node.get("max_events"))
    s.event_cap = static_cast<std::uint32_t>(n->integer(1, 50'000'000));
  if (const auto n = node.get("gzip")) s.gzip = n->boolean();
}

Expectation read_expectation(const io::JsonNode& node, const io::JsonText& text) {
  node.object({"step", "relation", "pairs", "fingerprint", "max_tests"});
  Expectation e;
  e.step = static_cast<std::uint32_t>(node.at("step").integer(0, kMaxId));
  e.place = text.where(node.pointer());
  if (const auto n = node.get("relation")) e.relation = n->choice<Relation>();
  if (const auto n = node.get("pairs")) e.pairs = n->integer(0, kAnySeed);
  if (const auto n = node.get("max_tests")) e.max_tests = n->integer(0, kAnySeed);
  if (const auto n = node.get("fingerprint")) {
    e.fingerprint = trace::from_hex(n->string());
    if (!e.fingerprint) n->fail("expected 16 lower-case hexadecimal digits");
  }
  return e;
}

}  // namespace

CollideRequest read_query(const io::JsonNode& node, StepQuestions* more) {
  if (node.has("max_time"))
    node.fail_key("max_time",
                  "a time limit would make the trace differ from run to run; use max_tests instead");
  std::vector<std::string> keys;
  for_each_field<CollideRequest>([&](const auto& field) { keys.emplace_back(field.name); });
  std::erase(keys, "max_time");
  if (more != nullptr)
    keys.insert(keys.end(), {"coherent", "distance", "clash", "near", "manifold", "points"});
  node.object(keys);
  const auto read_flag = [&](const char* key, bool& flag) {
    if (node.has(key)) flag = node.at(key).boolean();
  };
  if (more != nullptr) {
    read_flag("coherent", more->coherent);
    read_flag("distance", more->distance);
    if (const auto n = node.get("clash")) {  // a flag, or the limit of its steps
      if (n->json().is_number())
        more->clash.emplace().max_steps = n->integer(1, kAnySeed);
      else if (n->boolean())
        more->clash.emplace();
    }
    if (const auto n = node.get("near")) read_value(*n, more->near.emplace());
    if (const auto n = node.get("manifold")) read_value(*n, more->manifold.emplace());
    if (const auto n = node.get("points")) more->points = n->string();
  }
  CollideRequest r;
  for_each_field<CollideRequest>([&](const auto& field) {
    if (const auto n = node.get(std::string(field.name))) read_value(*n, r.*field.member);
  });
  if (!node.has("contacts"))
    r.contacts = r.mode == Mode::all_pairs && !r.is_coarse();
  else if (r.contacts && r.mode != Mode::all_pairs)
    node.at("contacts").fail("contacts need \"mode\": \"all\"");
  try {
    check_request(r);
  } catch (const InputError& e) {
    node.fail(e.what());
  }
  return r;
}

Scenario parse_scenario(const std::string& text, const std::string& file) {
  const io::JsonText json(text, file);
  const io::JsonNode root(json);
  root.object({"$schema", "name", "purpose", "seed", "show", "bodies", "towards", "motion", "query", "trace",
               "frames", "expect"});
  Scenario s;
  if (const auto n = root.get("$schema")) n->string();
  s.name = read_name(root.at("name"));
  s.purpose = root.at("purpose").string();
  if (const auto n = root.get("seed")) s.seed = n->integer(0, kAnySeed);
  if (const auto n = root.get("show")) s.show = n->choice<Show>();
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  s.bodies = read_bodies(root.at("bodies"), s.show, folder, s.seed);
  if (s.show == Show::collision) {
    s.motion = read_motion(root.at("motion"));
  } else {
    for (const char* key : {"motion", "query", "expect"})
      if (root.has(key))
        root.fail_key(key, "a refinement or a construction has one body and no query; remove it");
  }
  if (const auto n = root.get("towards")) {
    if (s.show != Show::refinement)
      root.fail_key("towards", "only a refinement goes towards points; remove it");
    for (const io::JsonNode& point : n->items(1)) s.towards.push_back(point.vector());
  }
  s.request.contacts = true;
  if (const auto n = root.get("query")) s.request = read_query(*n, &s.more);
  if (!s.more.points.empty()) s.more.points = (folder / s.more.points).string();
  if (const auto n = root.get("trace")) read_trace(*n, s);
  s.frames = default_frames(s.show);
  if (const auto n = root.get("frames")) s.frames = read_frames(*n, s.frames);
  if (s.frames.at == FrameSpec::At::pass && s.show != Show::construction)
    root.at("frames").fail_key("at", "only a construction has passes; use step, refinement or event");
  if (const auto n = root.get("expect"))
    for (const io::JsonNode& item : n->items()) s.expect.push_back(read_expectation(item, json));
  Fnv64 hash;
  hash.add_bytes(text.data(), text.size());
  s.hash = hash.value();
  return s;
}

std::vector<std::string> shipped_names(std::string_view ending) {
  std::vector<std::string> names;
  for (const io::EmbeddedFile& file : io::embedded_files())
    if (file.name.ends_with(ending))
      names.emplace_back(file.name.substr(0, file.name.size() - ending.size()));
  std::sort(names.begin(), names.end());
  return names;
}

NamedText open_named(const std::string& name_or_path, std::string_view ending, std::string_view what) {
  const bool is_name = name_or_path.find_first_of("./\\") == std::string::npos;
  if (is_name) {
    const std::string shipped = name_or_path + std::string(ending);
    for (const io::EmbeddedFile& file : io::embedded_files())
      if (file.name == shipped) return {std::string(file.text), shipped};
    std::error_code error;
    if (!std::filesystem::exists(name_or_path, error))
      throw InputError(name_or_path + ": neither a shipped " + std::string(what) + " nor a file" +
                       io::suggestion(name_or_path, shipped_names(ending)));
  }
  return {io::read_small_text(name_or_path), name_or_path};
}

std::string shipped_purpose(const std::string& name, std::string_view ending) {
  const NamedText named = open_named(name, ending, "file");
  return io::JsonNode(io::JsonText(named.text, named.file)).at("purpose").string();
}

Scenario open_scenario(const std::string& name_or_path) {
  if (has_mesh_extension(name_or_path))
    throw InputError(printable_name(name_or_path) +
                     ": expected a scenario, found a mesh; for two meshes use lrbscope collide A B, for one "
                     "lrbscope inspect or lrbscope figure");
  const NamedText scenario = open_named(name_or_path, kScenarioEnding, "scenario");
  return parse_scenario(scenario.text, scenario.file);
}

}  // namespace lrb::spec
