#include <Eigen/Geometry>

#include "scenarios/spec/scenario.hpp"

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

}  // namespace lrb::spec
