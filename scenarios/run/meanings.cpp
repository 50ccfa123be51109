/// The meaning of each column and key figure on the page of a run, for tooltips.

#include <string>
#include <utility>

#include "scenarios/run/run_charts.hpp"

namespace lrb::run {
namespace {

constexpr std::pair<std::string_view, std::string_view> kMeaningOfNames[] = {
    // Key figures.
    {"Relation",
     "how the bodies are to each other at the last step: separate, touching, crossing, or one inside the other"},
    {"Intersecting pairs", "pairs of intersecting faces, one of A and one of B; none is missed"},
    {"Contact regions", "connected groups of intersecting pairs"},
    {"First contact", "the step, with fraction, at which the surfaces first touch; proven"},
    {"Refined regions", "regions that the query removed from the wrappers because the other body is near"},
    {"Real faces", "faces of the bodies themselves, without pseudo faces"},
    {"Pseudo faces", "faces of the wrappers that are not faces of the body"},
    {"Outermost wrapper", "faces of the simplest surface that encloses the body"},
    {"Regions", "spaces between wrappers and body, removed one by one"},
    {"Without wrapper", "bodies without regions: the query compares all their faces"},
    {"Error bound", "largest deviation of the compared wrappers from the bodies, in mesh units; proven"},
    {"Penetration depth", "length of the shortest translation of B that separates the bodies; proven bounds"},
    {"Shared volume", "volume common to both bodies; proven bounds"},
    {"Passes", "passes of the builder that made regions"},
    {"Caps", "covers of a patch with fewer faces, which the builder accepted"},
    {"Queries", "queries in this recording"},
    {"Right verdicts", "queries whose yes or no agrees with the exact answer"},
    {"Right pairs", "pairs of triangles that the engine found and that intersect"},
    {"Missed pairs", "pairs of triangles that intersect and that the engine did not find"},
    {"False pairs", "pairs of triangles that the engine found and that are disjoint"},
    // Columns.
    {"step", "number of the time step"},
    {"query", "number of the query"},
    {"region", "number of the region"},
    {"layer", "pass of the builder that made the region; 0 lies on the body"},
    {"depth", "of a region: steps to the outside; of a tree node: steps to the root"},
    {"level", "number of regions between a face and the outside"},
    {"relation", "how the bodies are to each other at the step"},
    {"pairs", "intersecting pairs of faces"},
    {"faces", "faces in the group, real and pseudo"},
    {"tests", "exact comparisons of these faces with faces of the other body"},
    {"hits", "tests that found the faces to intersect"},
    {"misses", "tests of disjoint faces"},
    {"expansions", "tests that only exact arithmetic could decide"},
    {"box tests", "tests of two boxes, of tree nodes or of faces"},
    {"plane tests", "pairs of faces with overlapping boxes, compared by their planes"},
    {"face tests", "exact tests of two triangles (2D: segments)"},
    {"refinements", "regions removed from a wrapper"},
    {"refined", "times that the region was removed from its wrapper"},
    {"microseconds", "wall-clock time, recording included"},
    {"share", "part of the total"},
    {"events", "recorded events of this part"},
    {"count", "operations of this part, named in the next column"},
    {"fingerprint", "hash of the sorted pairs: equal answers have equal fingerprints"},
    {"error bound", "largest deviation of the compared wrappers from the bodies; 0: the answer is exact"},
    {"finished", "no: a limit was reached before the tolerance"},
    {"proof of separation", "faces of two disjoint wrappers that enclose the bodies"},
    {"distance", "smallest distance of the two surfaces, in mesh units; proven bounds"},
    {"contact kind", "clash class of the contact"},
    {"points inside", "points of B inside A"},
    {"smallest distance", "of the points of B to A, negative inside A"},
    {"near pairs", "pairs of triangles closer than the requested distance"},
    {"contact manifolds", "groups of contact points with one normal"},
    {"points", "contact points of all manifolds, before reduction"},
    {"nodes", "nodes of the tree at this depth"},
    {"expected", "nodes whose box a random line meets, by the surface area heuristic"},
    {"visited", "different nodes that were visited"},
    {"visits", "visited pairs of nodes that this depth is part of"},
    {"ended here", "visits that led no deeper"},
    {"curves", "intersection curves of the contact region"},
    {"length", "total length of the curves, in mesh units"},
    {"area", "area that the curves span, or of coplanar contact, in mesh units squared"},
    {"depth, estimated", "estimated translation of B along the normal that separates the region"},
    {"centroid", "centre of the contact region, world frame"},
    {"normal, A to B", "mean unit normal of the contact region, world frame"},
    {"A", "value of body A"},
    {"B", "value of body B"},
    {"body", "value of the body"},
    {"pass", "number of the pass"},
    {"max deviation", "deviation that the pass allows for its caps, in mesh units; estimated"},
    {"deviation", "largest deviation of the caps of the pass, in mesh units; estimated"},
    {"faces before", "faces of the front before the pass"},
    {"after", "faces of the front after the pass"},
    {"regions", "regions that the pass made"},
    {"patches", "parts of the front for which the pass tried a cap"},
    {"caps", "caps that were accepted, or have this verdict"},
    {"cost", "new faces for each face that the front loses"},
    {"rejected", "caps that were tried and not accepted"},
    {"engine's pairs", "pairs of triangles that the engine reported"},
    {"right", "reported pairs that intersect"},
    {"missed", "intersecting pairs that the engine did not report"},
    {"false", "reported pairs that are disjoint"},
    {"tests of volumes", "tests of two bounding volumes by the engine"},
    {"tests of triangles", "tests of two triangles by the engine"},
    {"thread", "thread of the engine that ran the query"},
    {"values", "how often the engine reported the counter"},
    {"least", "smallest value"},
    {"mean", "mean of the values"},
    {"greatest", "largest value"},
    {"sum", "sum of the values"},
};

}  // namespace

std::string_view meaning_for_engines(std::string_view name) {
  if (name == "Faces") return "faces of both bodies";
  if (name == "depth") return "steps to the root of the tree";
  if (name == "faces") return "faces of the bodies";
  return meaning_of_column(name);
}

std::string_view meaning_of_column(std::string_view name) {
  std::string column(name);  // a key figure without its own entry is named like a column
  if (!column.empty() && column[0] >= 'A' && column[0] <= 'Z') column[0] += 'a' - 'A';
  for (const std::string_view key : {name, std::string_view(column)})
    for (const auto& [entry, meaning] : kMeaningOfNames)
      if (entry == key) return meaning;
  return {};
}

}  // namespace lrb::run
