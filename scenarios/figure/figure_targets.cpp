#include "scenarios/figure/figure_targets.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "render/pictures/panel.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/scene.hpp>

namespace lrb::figure {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number out{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return out;
}

std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> out;
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = text.find(':');
    out.push_back(text.substr(0, end));
    if (end != std::string_view::npos) text.remove_prefix(end + 1);
  }
  return out;
}

bool is_letter(std::string_view text) {
  return !text.empty() && text.size() <= 2 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

/// Reads a face or a region from its kind and number. Returns false if they are neither.
bool read_target(std::string_view kind, std::string_view number, Target& out) {
  if (kind != "face" && kind != "region") return false;
  out.kind = kind == "face" ? Target::Kind::face : Target::Kind::region;
  if (number.starts_with('a') || number.starts_with('b')) {
    out.body = number[0] == 'b' ? 1 : 0;
    number.remove_prefix(1);
  }
  const std::optional<std::uint32_t> value = number_of<std::uint32_t>(number);
  out.number = value.value_or(0);
  return value.has_value();
}

double length(const AlignedBox2d& box) {
  return box.sizes().norm();
}

/// Returns true if a segment crosses a diagonal of a box.
bool crosses(const Vector2d& a, const Vector2d& b, const AlignedBox2d& box) {
  return cross(a, b, box.min(), box.max()) ||
         cross(a, b, {box.min().x(), box.max().y()}, {box.max().x(), box.min().y()});
}

Vector2d nearest_point(const AlignedBox2d& box, const Vector2d& to) {
  return to.cwiseMax(box.min()).cwiseMin(box.max());
}

}  // namespace

Callout parse_callout(const std::string& text) {
  Callout out;
  out.option = "--callout " + printable_name(text);
  const std::size_t equals = text.find('=');
  std::vector<std::string_view> parts = parts_of(std::string_view(text).substr(0, equals));
  if (parts.size() == 3 && is_letter(parts[0])) {
    out.panel = parts[0];
    parts.erase(parts.begin());
  }
  if (parts.size() != 2 || !read_target(parts[0], parts[1], out.target) || equals + 1 == text.size())
    throw InputError(
        out.option +
        ": expected [PANEL:]face:N or [PANEL:]region:N, N after b for body B, and =TEXT for another "
        "text; such as c:face:b12=tooth");
  if (equals != std::string::npos) out.text = text.substr(equals + 1);
  return out;
}

Inset parse_inset(const std::string& text) {
  constexpr double kLeast = 1.1, kMax = 200;
  Inset out;
  out.option = "--inset " + printable_name(text);
  std::vector<std::string_view> parts = parts_of(text);
  bool good = parts.size() > 1 && is_letter(parts[0]);
  if (good) {
    out.panel = parts[0];
    const bool contact = parts[1] == "contact";
    if (contact) out.target.kind = Target::Kind::contact;
    good = contact || (parts.size() > 2 && read_target(parts[1], parts[2], out.target));
    const std::size_t last = contact ? 2 : 3;
    if (parts.size() == last + 1) {
      const std::optional<double> value = number_of<double>(parts[last]);
      good = good && value && *value >= kLeast && *value <= kMax;
      out.magnification = value.value_or(0);
    }
    good = good && parts.size() <= last + 1;
  }
  if (!good)
    throw InputError(out.option +
                     ": expected PANEL:face:N, PANEL:region:N or PANEL:contact, N after b for body B, and "
                     ":MAGNIFICATION from 1.1 to 200; such as c:region:b7:4");
  return out;
}

void check_target(const std::string& option, const Target& target, std::span<const LrbRep* const> reps) {
  if (target.body >= reps.size()) throw InputError(option + ": the run has no body B");
  if (target.kind == Target::Kind::contact) {
    if (reps.size() < 2) throw InputError(option + ": the run has one body, and so no contact");
    return;
  }
  const LrbRep& rep = *reps[target.body];
  const bool face = target.kind == Target::Kind::face;
  const std::uint32_t count = face ? rep.face_count() : rep.region_count();
  if (target.number < count) return;
  throw InputError(option + ": expected a number below " + std::to_string(count) +
                   ", which is the number of " + (face ? "real and pseudo faces" : "regions") + " of " +
                   rep.name());
}

std::string name_of(const Target& target, std::size_t bodies) {
  if (target.kind == Target::Kind::contact) return "contact";
  return (target.kind == Target::Kind::face ? "face " : "region ") + std::to_string(target.number) +
         (bodies < 2         ? ""
          : target.body == 0 ? " of A"
                             : " of B");
}

std::vector<std::vector<Vector3d>> outlines(const Target& target, const LrbRep& rep, const Pose& pose) {
  if (target.kind == Target::Kind::face) {
    std::vector<Vector3d> loop = pictures::corners_of(rep, FaceId(target.number), pose);
    if (rep.dim() == 3) loop.push_back(loop.front());
    return {loop};
  }
  // Step 1: the directed edges of the lids without those of two lids. In 2D the edges are the lids, and the
  // floor against its direction, which together are a cycle.
  std::multimap<VertexId, VertexId> next;
  const RegionId region(target.number);
  const auto add = [&](VertexId from, VertexId to) {
    const auto [first, last] = next.equal_range(to);
    for (auto it = first; it != last; ++it) {
      if (it->second != from) continue;
      next.erase(it);
      return;
    }
    next.emplace(from, to);
  };
  for (const FaceId f : rep.lids(region)) {
    const std::span<const VertexId> corners = rep.face(f);
    for (std::size_t i = 0; i < (rep.dim() == 2 ? 1 : corners.size()); ++i)
      add(corners[i], corners[(i + 1) % corners.size()]);
  }
  if (rep.dim() == 2)
    for (const FaceId f : rep.floor(region)) add(rep.face(f)[1], rep.face(f)[0]);
  // Step 2: chains of these edges.
  std::vector<std::vector<Vector3d>> out;
  const auto point = [&](VertexId v) { return pose.apply(rep.vertices()[v]); };
  while (!next.empty()) {
    std::vector<Vector3d> chain = {point(next.begin()->first)};
    for (auto it = next.begin(); it != next.end();) {
      const VertexId to = it->second;
      chain.push_back(point(to));
      next.erase(it);
      it = next.find(to);
    }
    out.push_back(std::move(chain));
  }
  return out;
}

void add_outlines(render::DrawList& list, const Target& target, const LrbRep& rep, const Pose& pose,
                  double thin, const render::Style& style) {
  for (std::vector<Vector3d>& chain : outlines(target, rep, pose)) {
    render::DrawLine line;
    line.closed = chain.size() > 2 && chain.front() == chain.back();
    if (line.closed) chain.pop_back();
    line.points = std::move(chain);
    line.colour = style.ink;
    line.width = static_cast<float>(2 * thin);
    line.halo = style.paper;
    line.halo_width = static_cast<float>(thin);
    line.layer = render::Layer::on_top;
    list.lines.push_back(std::move(line));
  }
}

namespace {

std::vector<AlignedBox2d> contact_boxes(const Inset& inset, const render::Projection& projection,
                                        std::span<const ContactRegion> contacts) {
  constexpr std::size_t kMax = 3;
  std::vector<AlignedBox2d> out;
  for (const ContactRegion& region : contacts) {
    AlignedBox2d box;
    for (const Vector3d& x : render::contact_points({&region, 1}))
      if (const auto at = projection.to_pixel(x)) box.extend(*at);
    const auto joins = [&](const AlignedBox2d& other) {
      const bool joined = other.intersects(box);
      if (joined) box.extend(other);
      return joined;
    };
    while (std::erase_if(out, joins) > 0) {  // a larger box may overlap others
    }
    if (!box.isEmpty()) out.push_back(box);
  }
  if (out.empty()) throw InputError(inset.option + ": expected a panel with a contact, found none in it");
  const auto sort_by = [&out](const auto& value) {
    std::sort(out.begin(), out.end(), [&](const auto& p, const auto& q) { return value(p) < value(q); });
  };
  sort_by([](const AlignedBox2d& box) { return -box.diagonal().norm(); });
  if (out.size() > kMax) out.resize(kMax);
  sort_by([](const AlignedBox2d& box) { return box.center().x(); });
  return out;
}

}  // namespace

std::vector<AlignedBox2d> target_boxes(const Inset& inset, const render::Projection& projection,
                                       const LrbRep& rep, const Pose& pose,
                                       std::span<const ContactRegion> contacts) {
  const Target& target = inset.target;
  if (target.kind == Target::Kind::contact) return contact_boxes(inset, projection, contacts);
  std::vector<Vector3d> points;
  if (target.kind == Target::Kind::face)
    points = pictures::corners_of(rep, FaceId(target.number), pose);
  else
    for (const Vector3d& x : pictures::region_corners(rep, RegionId(target.number)))
      points.push_back(pose.apply(x));
  AlignedBox2d out;
  for (const Vector3d& x : points)
    if (const auto at = projection.to_pixel(x)) out.extend(*at);
  if (out.isEmpty()) throw InputError(inset.option + ": is behind the camera of its panel");
  return {out};
}

bool cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto turn = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
  };
  const auto around = [](const Vector2d& p, const Vector2d& q) {
    return AlignedBox2d(p.cwiseMin(q), p.cwiseMax(q));
  };
  return turn(a, b, c) * turn(a, b, d) <= 0 && turn(c, d, a) * turn(c, d, b) <= 0 &&
         around(a, b).intersects(around(c, d));
}

std::array<render::Canvas::Loop, 3> frame_of(const Piece& panel, const Piece& inset) {
  const auto on_paper = [&](const Vector2d& x) {
    return Vector2d(panel.place.box.min() + (x - panel.shown.min()) * panel.scale);
  };
  const AlignedBox2d frame(on_paper(inset.shown.min()), on_paper(inset.shown.max())), &box = inset.place.box;
  const render::Canvas::Loop line = {{frame.center().x(), frame.max().y()},
                                     {box.center().x(), box.min().y()}};
  if (inset.has_one_line) return {render::corners(frame), line, line};
  return {render::corners(frame),
          {Vector2d(frame.min().x(), frame.max().y()), box.min()},
          {frame.max(), Vector2d(box.max().x(), box.min().y())}};
}

void uncross(const Piece& panel, std::span<Piece> insets) {
  constexpr std::size_t kMax = 6;  // of which all orders are tried
  if (insets.size() < 2 || insets.size() > kMax) return;
  std::vector<AlignedBox2d> squares, best;
  for (const Piece& inset : insets) squares.push_back(inset.place.box);
  const auto put = [&](const std::vector<AlignedBox2d>& boxes) {
    for (std::size_t k = 0; k < insets.size(); ++k) insets[k].place.box = boxes[k];
  };
  const auto is_before = [](const AlignedBox2d& a, const AlignedBox2d& b) {
    return std::pair(a.min().y(), a.min().x()) < std::pair(b.min().y(), b.min().x());
  };
  std::sort(squares.begin(), squares.end(), is_before);
  std::ptrdiff_t least = std::numeric_limits<std::ptrdiff_t>::max();
  do {
    put(squares);
    std::vector<render::Canvas::Loop> lines;
    std::ptrdiff_t crossings = 0;
    for (const Piece& inset : insets)
      for (const std::size_t k : {1, 2}) {
        const render::Canvas::Loop line = frame_of(panel, inset)[k];
        crossings += std::count_if(lines.begin(), lines.end(), [&](const render::Canvas::Loop& other) {
          return cross(line[0], line[1], other[0], other[1]);
        });
        lines.push_back(line);
      }
    if (crossings < least) best = squares;
    least = std::min(least, crossings);
  } while (std::next_permutation(squares.begin(), squares.end(), is_before));
  put(best);
  for (Piece& inset : insets) inset.has_one_line = least > 0;
}

Vector3d anchor(const Target& target, const LrbRep& rep, const Pose& pose) {
  const auto centre = [&](FaceId f) {
    Vector3d sum = Vector3d::Zero();
    const std::vector<Vector3d> corners = pictures::corners_of(rep, f, pose);
    for (const Vector3d& x : corners) sum += x;
    return Vector3d(sum / static_cast<double>(corners.size()));
  };
  if (target.kind == Target::Kind::face) return centre(FaceId(target.number));
  const std::span<const FaceId> lids = rep.lids(RegionId(target.number));
  Vector3d mean = Vector3d::Zero();
  for (const FaceId f : lids) mean += centre(f) / static_cast<double>(lids.size());
  Vector3d best = mean;
  double least = std::numeric_limits<double>::infinity();
  for (const FaceId f : lids) {
    const Vector3d x = centre(f);
    if ((x - mean).squaredNorm() < least) least = (x - mean).squaredNorm(), best = x;
  }
  return best;
}

std::vector<CalloutPlace> place_callouts(const AlignedBox2d& box, const AlignedBox2d& panel,
                                         const render::Image& content,
                                         const std::vector<std::vector<Vector2d>>& frames,
                                         const std::vector<Vector2d>& anchors,
                                         const std::vector<Vector2d>& sizes) {
  constexpr double kFree = 3;  // points from a text to any anchor
  // Costs: of a text entirely over content; of a leader as long as the panel's diagonal; of a leader that
  // crosses a text, or in the first turn another leader; of a text over an anchor; of a text over another or
  // over a frame; of leaders that cross in later turns.
  constexpr double kCovering = 12, kLength = 0.8, kCrossing = 1, kOnAnchor = 15, kOnText = 40, kCrossed = 1e4;
  // Step 1: the sums of covered pixels above and to the left, for the share of content under any box.
  const int w = content.width(), h = content.height();
  std::vector<int> sums(static_cast<std::size_t>(w + 1) * (h + 1), 0);
  const auto sum = [&](int x, int y) -> int& { return sums[static_cast<std::size_t>(y) * (w + 1) + x]; };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      sum(x + 1, y + 1) = sum(x, y + 1) + sum(x + 1, y) - sum(x, y) + (content.at(x, y).a > 0 ? 1 : 0);
  const Vector2d unit = panel.sizes().cwiseQuotient(Vector2d(std::max(w, 1), std::max(h, 1)));
  const auto covered = [&](const AlignedBox2d& text) {
    const auto pixel = [](double x) { return static_cast<int>(std::lround(x)); };
    const auto upto = [&](int x, int y) { return sum(std::clamp(x, 0, w), std::clamp(y, 0, h)); };
    const Vector2d low = (text.min() - panel.min()).cwiseQuotient(unit),
                   high = (text.max() - panel.min()).cwiseQuotient(unit);
    const int x0 = pixel(low.x()), x1 = pixel(high.x()), y0 = pixel(low.y()), y1 = pixel(high.y());
    const int area = std::max((x1 - x0) * (y1 - y0), 1);  // with the pixels that are outside of the content
    return static_cast<double>(upto(x1, y1) - upto(x0, y1) - upto(x1, y0) + upto(x0, y0)) / area;
  };
  // Step 2: one text after the other, at the place of least cost. In later turns they are placed again,
  // because the first ones are in the way of others.
  constexpr std::size_t kTurns = 4;
  std::vector<CalloutPlace> out;
  std::vector<AlignedBox2d> texts;
  for (std::size_t place = 0; place < kTurns * anchors.size(); ++place) {
    const std::size_t i = place % anchors.size();
    const double crossing = place == i ? kCrossing : kCrossed;
    const Vector2d half = 0.5 * sizes[i], low = box.min() + half, room = (box.sizes() - sizes[i]).cwiseMax(0);
    CalloutPlace best;
    AlignedBox2d best_text;
    double least = std::numeric_limits<double>::infinity();
    const int columns = 1 + static_cast<int>(room.x() / kPlaceStep),
              rows = 1 + static_cast<int>(room.y() / kPlaceStep);
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const Vector2d share(columns > 1 ? column / (columns - 1.0) : 0.5,
                             rows > 1 ? row / (rows - 1.0) : 0.5);
        const Vector2d at = low + room.cwiseProduct(share);
        const AlignedBox2d text(at - half, at + half);
        const Vector2d end = nearest_point(text, anchors[i]);
        const double share_covered = covered(text);
        double cost = kCovering * share_covered + kLength * (end - anchors[i]).norm() / length(box);
        for (const Vector2d& a : anchors)
          if ((nearest_point(text, a) - a).norm() < kFree) cost += kOnAnchor;
        for (const std::vector<Vector2d>& frame : frames)
          for (std::size_t k = 0; k < frame.size(); ++k)
            if (crosses(frame[k], frame[(k + 1) % frame.size()], text)) cost += kOnText;
        for (std::size_t k = 0; k < out.size(); ++k) {
          if (k == i) continue;
          if (texts[k].intersects(text)) cost += kOnText;
          if (cross(end, anchors[i], out[k].leader, anchors[k])) cost += crossing;
          if (crosses(end, anchors[i], texts[k]) || crosses(out[k].leader, anchors[k], text))
            cost += kCrossing;
        }
        if (cost < least) least = cost, best = {at, end, share_covered}, best_text = text;
      }
    if (place == i) out.emplace_back(), texts.emplace_back();
    out[i] = best, texts[i] = best_text;
  }
  return out;
}

}  // namespace lrb::figure
