#pragma once

#include <optional>

#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// Returns the certificate for two bodies that are known to be separate. Starts from the outermost wrappers,
/// refines what meets, the larger one of two regions, and at the end takes everything back in that can be.
/// There is none for bodies that are not closed or intersect themselves, or that are nearer than
/// wrapper_margin(): they cannot then be told from what hides them.
std::optional<Separation> find_separation(QueryContext& context);

}  // namespace lrb
