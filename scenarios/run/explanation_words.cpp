#include "scenarios/run/explanation_words.hpp"

namespace lrb::run {

std::string_view words(DecidedBy by) {
  switch (by) {
    case DecidedBy::node_boxes:
      return "boxes of the trees' nodes, which are apart";
    case DecidedBy::node_edges:
      return "a direction across the edges of two nodes' boxes, which are apart along it";
    case DecidedBy::face_boxes:
      return "the faces' own boxes, which are apart";
    case DecidedBy::planes:
      return "the plane of one face, which has all of the other on one side, in floats with bounded errors";
    case DecidedBy::floats:
      return "floats with bounded errors, which are certain here";
    case DecidedBy::exact:
      return "the exact test, because floats were not certain";
  }
  return {};
}

}  // namespace lrb::run
