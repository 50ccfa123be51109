#include "engine/construct/open_front.hpp"

#include <cmath>
#include <utility>

#include "engine/construct/embed_check.hpp"
#include "engine/construct/front_update.hpp"
#include "engine/core/geometry.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::construct {

namespace {

using Index = OpenFront::Index;

}  // namespace

OpenFront::OpenFront(const FrontMesh& front, const std::vector<bool>& frozen, bool merges_planes)
    : front_(front), real_faces_(frozen.size()), merges_planes_(merges_planes) {
  const Slot count = front.slot_count();
  const FrontMesh::Corner corners = front.point_count();
  for (FrontMesh::Corner c = 0; c < corners; ++c) box_.extend(front.x(c));
  // Both the unit and its inverse are normal numbers.
  unit_ = std::ldexp(1.0, std::clamp(std::ilogb(size()), -1000, 1000));
  faces_.reserve(count + count / 2);
  states_.reserve(count + count / 2);
  x_.reserve(2 * corners);
  std::uint32_t names = corners;
  for (FrontMesh::Corner c = 0; c < corners; ++c) {
    x_.push_back(front.x(c));
    face_of_.push_back(kNull);
    corner_.push_back(c);
    id_.push_back(front.point(c).id);
    name_.push_back(front.point(c).id);
    names = std::max<std::uint32_t>(names, front.point(c).id + 1);
  }
  first_name_ = names - corners;
  changed_at_.assign(corners, 0);
  mark_.assign(names, 0);
  if (front.has_polygons()) polygon_component_.assign(count, kNull);
  for (Slot s = 0; s < count; ++s) {
    const FrontMesh::Triangle& t = front[s];
    faces_.push_back({t.v, t.across, kNull, 0, Vector3::Zero(), 0});
    states_.emplace_back();
    face_at_.push_back(front.alive(s) ? s : kNull);
    if (!front.alive(s)) {
      free_.push_back(s);
      continue;
    }
    set_plane(faces_[s]);
    State& state = states_[s];
    state.slot = state.hint = s;
    state.alive = true;
    if (t.face < frozen.size() && frozen[t.face])
      state.excluded_below = std::numeric_limits<float>::infinity(), has_excluded_ = true;
    for (const Index v : t.v) face_of_[v] = s;
  }
}

std::uint32_t OpenFront::excluded(float limit) const {
  if (!has_excluded_) return 0;
  return static_cast<std::uint32_t>(std::count_if(
      states_.begin(), states_.end(), [&](const State& s) { return s.alive && s.excluded_below > limit; }));
}

void OpenFront::set_plane(Face& f) const {
  const double scale = 1 / unit_;
  const Vector3 c = ((x_[f.v[1]] - x_[f.v[0]]) * scale).cross((x_[f.v[2]] - x_[f.v[0]]) * scale);
  const double length = norm3(c);
  f.area = static_cast<float>(length / 2);
  f.n = length > 0 ? Vector3(c / length) : Vector3(Vector3::Zero());
  f.d = dot3(f.n, x_[f.v[0]]);
}

Eigen::AlignedBox3d OpenFront::box(Index f) const {
  Eigen::AlignedBox3d b(x_[faces_[f].v[0]]);
  b.extend(x_[faces_[f].v[1]]);
  b.extend(x_[faces_[f].v[2]]);
  return b;
}

// Stars.

/// Returns the face in which an edge runs from u to v, or kNull.
Index OpenFront::edge_face(Index u, Index v, int& edge) const {
  const Index first = face_of_[u];
  Index f = first;
  do {
    const Face& t = faces_[f];
    const int i = index_of(t, u);
    if (t.v[(i + 1) % 3] == v) {
      edge = i;
      return f;
    }
    f = t.across[(i + 2) % 3];
  } while (f != first);
  return kNull;
}

/// Adds the faces around `centre` that lie between `first` and `last`. Returns false if there are too many.
bool OpenFront::add_fan(Star& star, Index centre, Index first, Index last) const {
  for (Index f = first;;) {
    const Face& t = faces_[f];
    f = t.across[(index_of(t, centre) + 2) % 3];
    if (f == last) return true;
    if (star.rim.full()) return false;
    const Face& g = faces_[f];
    const int i = index_of(g, centre);
    star.faces.push_back(f);
    star.rim.push_back({g.v[(i + 1) % 3], g.v[(i + 2) % 3], g.across[(i + 1) % 3], f});
  }
}

bool OpenFront::find_star(Index u, Index v, bool onto_v, Star& star) const {
  int i = 0;
  const Index first = edge_face(u, v, i);
  if (first == kNull) return false;
  const Index last = faces_[first].across[i];
  star.u = u, star.v = v, star.onto_v = onto_v, star.edge = i;
  star.faces.clear();
  star.rim.clear();
  star.faces.push_back(first);
  if (!add_fan(star, u, first, last)) return false;
  star.faces.push_back(last);
  if (!onto_v) return add_fan(star, v, last, first) && star.rim.size() >= 3;
  star.first_across = faces_[first].across[(i + 1) % 3];
  star.last_across = faces_[last].across[(index_of(faces_[last], v) + 2) % 3];
  return star.rim.size() >= 1;
}

bool OpenFront::leaves_surface(const Star& star) {
  ++marker_;
  if (!star.onto_v) {
    // No vertex twice on the rim, nor two copies of one.
    for (const RimEdge& r : star.rim) {
      if (mark_[name_[r.a]] == marker_) return false;
      mark_[name_[r.a]] = marker_;
    }
    return true;
  }
  // Neighbours of v are not neighbours of u, but for the two at their common faces.
  mark_[name_[star.v]] = marker_;
  const Index first = face_of_[star.v];
  Index f = first;
  do {
    const Face& t = faces_[f];
    const int i = index_of(t, star.v);
    mark_[name_[t.v[(i + 1) % 3]]] = marker_;
    f = t.across[(i + 2) % 3];
  } while (f != first);
  for (std::size_t k = 0; k + 1 < star.rim.size(); ++k)
    if (mark_[name_[star.rim[k].b]] == marker_) return false;
  return name_[star.rim.front().a] != name_[star.rim.back().b];
}

// Components.

Index OpenFront::leader(Index c) const {
  while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
  return c;
}

void OpenFront::unite(Index f, float limit, Union& with) const {
  if (has_excluded_ && states_[f].excluded_below > limit) with.excluded = true;
  Index c = faces_[f].component;
  if (c == kNull && front_.has_polygons()) {
    const auto polygon = front_.unit(states_[f].slot);
    if (polygon.last - polygon.first > 1) {
      c = polygon_component_[polygon.first];
      if (c == kNull) {
        if (std::find(with.polygons.begin(), with.polygons.end(), polygon.first) != with.polygons.end())
          return;
        with.polygons.push_back(polygon.first);
        with.floor += polygon.last - polygon.first;
        with.faces += merges_planes_ ? 1 : polygon.last - polygon.first;
        return;
      }
    }
  }
  if (c == kNull) {
    ++with.floor, ++with.faces;
    return;
  }
  c = leader(c);
  if (std::find(with.components.begin(), with.components.end(), c) != with.components.end()) return;
  with.components.push_back(c);
  with.floor += components_[c].size;
  with.faces += components_[c].faces;
  with.collapses += components_[c].collapses;
}

/// Returns the component of a collapse that unites these.
Index OpenFront::merge(const Star& star, const Union& united) {
  Index c;
  if (united.components.empty()) {
    c = component_count();
    components_.emplace_back();
    parent_.push_back(c);
  } else {
    c = *std::max_element(united.components.begin(), united.components.end(), [&](Index a, Index b) {
      return components_[a].floor.size() < components_[b].floor.size();
    });
    for (const Index o : united.components) {
      if (o == c) continue;
      parent_[o] = c;
      components_[c].careful |= components_[o].careful;
      components_[c].floor.insert(components_[c].floor.end(), components_[o].floor.begin(),
                                  components_[o].floor.end());
      components_[o].floor = std::vector<Index>();  // `= {}` would keep the memory
    }
  }
  components_[c].size = united.floor;
  components_[c].faces = united.faces;
  components_[c].collapses = united.collapses + 1;
  for (const Slot s : united.polygons) polygon_component_[s] = c;
  if (was_restored_)
    for (const Index f : star.faces) components_[c].careful |= states_[f].careful;
  return c;
}

/// Removes a face: a committed one becomes part of the floor, one of a lid is free for reuse.
void OpenFront::cover(Index f, Index component) {
  states_[f].alive = false;
  if (faces_[f].component == kNull) {
    faces_[f].component = component;
    components_[component].floor.push_back(f);
  } else {
    free_.push_back(f);
  }
}

Index OpenFront::new_face() {
  if (!free_.empty()) {
    const Index f = free_.back();
    free_.pop_back();
    return f;
  }
  faces_.emplace_back();
  states_.emplace_back();
  return face_count() - 1;
}

Index OpenFront::new_vertex(const Vector3& at) {
  const Index v = vertex_count();
  x_.push_back(at);
  face_of_.push_back(kNull);
  changed_at_.push_back(0);
  corner_.push_back(kNull);
  // Numbers of the complex are below this.
  constexpr std::uint32_t kOfLids = 1u << 31;
  id_.push_back(VertexId(kOfLids + v));
  name_.push_back(first_name_ + v);
  mark_.push_back(0);
  return v;
}

void OpenFront::set_across(Index f, Index a, Index b, Index to) {
  Face& t = faces_[f];
  t.across[t.v[0] == a && t.v[1] == b ? 0 : t.v[1] == a && t.v[2] == b ? 1 : 2] = to;
}

Index OpenFront::collapse(const Star& star, const Union& united, const Vector3& at,
                          std::span<const Slot> hints, float deviation) {
  ++time_;
  const Index c = merge(star, united);
  const std::size_t n = star.rim.size();
  // New faces must not take the places of those that they replace, which are still read.
  fresh_.clear();
  for (std::size_t k = 0; k < n; ++k) fresh_.push_back(new_face());
  for (const Index f : star.faces) cover(f, c);
  Index w = star.v;
  if (!star.onto_v) {
    w = new_vertex(at);
    face_of_[star.v] = kNull;
  }
  face_of_[star.u] = kNull;
  for (std::size_t k = 0; k < n; ++k) {
    const RimEdge& r = star.rim[k];
    Face& f = faces_[fresh_[k]];
    f.v = {r.a, r.b, w};
    f.across = {r.across,
                k + 1 < n     ? fresh_[k + 1]
                : star.onto_v ? star.last_across
                              : fresh_[0],
                k > 0         ? fresh_[k - 1]
                : star.onto_v ? star.first_across
                              : fresh_[n - 1]};
    f.component = c;
    set_plane(f);
    State& state = states_[fresh_[k]];
    state = {};
    if (!hints.empty()) state.hint = hints[k];
    state.deviation = deviation;
    state.alive = true;
    set_across(r.across, r.b, r.a, fresh_[k]);
    face_of_[r.a] = fresh_[k];
    changed_at_[r.a] = time_;
  }
  if (star.onto_v) {
    const Index a = star.rim.front().a, b = star.rim.back().b;
    set_across(star.first_across, a, w, fresh_[0]);
    set_across(star.last_across, w, b, fresh_[n - 1]);
    face_of_[b] = fresh_[n - 1];
    changed_at_[b] = time_;
  }
  face_of_[w] = fresh_[0];
  changed_at_[w] = time_;
  return w;
}

// Polygons.

std::vector<Index> OpenFront::uncovered_parts(Index component, bool merged) const {
  std::vector<Index> parts;
  if (!front_.has_polygons()) return parts;
  for (const Index f : components_[component].floor) {
    if (is_merged(states_[f].slot) != merged) continue;
    const auto polygon = front_.unit(states_[f].slot);
    for (Slot s = polygon.first; s < polygon.last; ++s)
      if (states_[face_at_[s]].alive) parts.push_back(face_at_[s]);
  }
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

bool OpenFront::flip_outward(Index component, Index f, int i, Index* flipped) {
  const Index g = faces_[f].across[i];
  // The face beyond must be of the lid.
  if (faces_[g].component == kNull || leader(faces_[g].component) != component) return false;
  const Face own = faces_[f], other = faces_[g];
  const Index a = own.v[i], b = own.v[(i + 1) % 3], c = own.v[(i + 2) % 3];
  const int j = index_of(other, b);
  const Index w = other.v[(j + 2) % 3];
  // The flipped surface must be in front of the old one. Exact.
  if (exact::orient3d(x_[own.v[0]].data(), x_[own.v[1]].data(), x_[own.v[2]].data(), x_[w].data()) <= 0)
    return false;
  // The new edge must not exist yet.
  const Index first = face_of_[c];
  Index at = first;
  do {
    const Face& t = faces_[at];
    const int k = index_of(t, c);
    if (name_[t.v[(k + 1) % 3]] == name_[w]) return false;
    at = t.across[(k + 2) % 3];
  } while (at != first);
  if (name_[c] == name_[w]) return false;
  // At the face's other edges, the new faces must start on the outer side.
  const auto turns = [&](Index from, Index to, Index third, Index beyond) {
    return turns_outward(x_[from], x_[to], x_[third], x_[w], x_[corner_opposite(beyond, from, to)]);
  };
  if (!turns(b, c, a, own.across[(i + 1) % 3]) || !turns(c, a, b, own.across[(i + 2) % 3])) return false;
  ++time_;
  const Index beyond_bc = own.across[(i + 1) % 3], beyond_ca = own.across[(i + 2) % 3];
  const Index beyond_aw = other.across[(j + 1) % 3], beyond_wb = other.across[(j + 2) % 3];
  const Index h = new_face(), k = new_face();
  cover(f, component);
  cover(g, component);
  const float deviation = std::max(states_[f].deviation, states_[g].deviation);
  put(h, component, {b, c, w}, {beyond_bc, k, beyond_wb}, states_[f].hint, deviation);
  put(k, component, {c, a, w}, {beyond_ca, beyond_aw, h}, states_[g].hint, deviation);
  set_across(beyond_bc, c, b, h);
  set_across(beyond_wb, b, w, h);
  set_across(beyond_ca, a, c, k);
  set_across(beyond_aw, w, a, k);
  flipped[0] = h, flipped[1] = k;
  return true;
}

void OpenFront::put(Index n, Index component, const std::array<Index, 3>& v,
                    const std::array<Index, 3>& across, Slot hint, float deviation) {
  faces_[n].v = v, faces_[n].across = across, faces_[n].component = component;
  set_plane(faces_[n]);
  states_[n] = {};
  states_[n].hint = hint;
  states_[n].deviation = deviation;
  states_[n].alive = true;
  for (const Index corner : v) face_of_[corner] = n, changed_at_[corner] = time_;
}

std::array<Index, 3> OpenFront::raise(Index component, Index f, const Vector3& at) {
  ++time_;
  const Face own = faces_[f];
  const std::array<Index, 3> fresh = {new_face(), new_face(), new_face()};
  const Index w = new_vertex(at);
  cover(f, component);
  for (int i = 0; i < 3; ++i) {
    const Index a = own.v[i], b = own.v[(i + 1) % 3];
    put(fresh[i], component, {a, b, w}, {own.across[i], fresh[(i + 1) % 3], fresh[(i + 2) % 3]},
        states_[f].hint, states_[f].deviation);
    set_across(own.across[i], b, a, fresh[i]);
  }
  return fresh;
}

Index OpenFront::keep(Index component, Index f) {
  const Index fresh = new_face();
  const Face own = faces_[f];
  cover(f, component);
  put(fresh, component, own.v, own.across, states_[f].hint, states_[f].deviation);
  for (int i = 0; i < 3; ++i) set_across(own.across[i], own.v[(i + 1) % 3], own.v[i], fresh);
  return fresh;
}

// Commits.

std::vector<OpenFront::Lid> OpenFront::lids() const {
  std::vector<Lid> lids;
  std::vector<std::uint32_t> number(components_.size(), kNull);
  for (Index f = 0; f < face_count(); ++f) {
    if (!states_[f].alive || faces_[f].component == kNull) continue;
    const Index c = leader(faces_[f].component);
    if (number[c] == kNull) {
      number[c] = static_cast<std::uint32_t>(lids.size());
      lids.push_back({c, {}});
    }
    lids[number[c]].faces.push_back(f);
  }
  return lids;
}

void OpenFront::restore(const Lid& lid, float excluded_below) {
  ++time_;
  std::vector<PointTriangle> old, added;
  const std::vector<Index> floor = std::move(components_[lid.component].floor);
  for (const Index f : floor) old.push_back(faces_[f].v);
  for (const Index f : lid.faces) added.push_back(faces_[f].v);
  const EdgeIndex old_edges(old), added_edges(added);
  for (const Index f : lid.faces)
    for (const Index v : faces_[f].v) face_of_[v] = kNull;
  for (const Index f : floor) {
    Face& face = faces_[f];
    face.component = kNull;
    for (int i = 0; i < 3; ++i) {
      const Index a = face.v[i], b = face.v[(i + 1) % 3];
      if (const std::uint32_t beside = old_edges.find(b, a); beside != kNull) {
        face.across[i] = floor[beside];
      } else {
        const Index top = lid.faces[added_edges.find(a, b)];
        const Face& t = faces_[top];
        face.across[i] = t.across[index_of(t, a)];
        set_across(face.across[i], b, a, f);
      }
      face_of_[a] = f;
      changed_at_[a] = time_;
    }
    State& state = states_[f];
    state.alive = true;
    state.careful = true;
    state.excluded_below = std::max(state.excluded_below, excluded_below);
    has_excluded_ |= excluded_below > 0;
    if (const auto polygon = front_.unit(state.slot); polygon.last - polygon.first > 1)
      polygon_component_[polygon.first] = kNull;
  }
  for (const Index f : lid.faces) {
    states_[f].alive = false;
    free_.push_back(f);
  }
  was_restored_ = true;
}

void OpenFront::commit(const Lid& lid, std::span<const Slot> slots) {
  std::vector<Index> floor = std::move(components_[lid.component].floor);
  for (const Index f : floor) {
    face_at_[states_[f].slot] = kNull;
    states_[f].slot = kNull;
    free_.push_back(f);
  }
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Index f = lid.faces[i];
    faces_[f].component = kNull;
    states_[f].slot = slots[i];
    if (slots[i] >= face_at_.size()) face_at_.resize(slots[i] + 1, kNull);
    face_at_[slots[i]] = f;
  }
}

}  // namespace lrb::construct
