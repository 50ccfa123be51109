#pragma once

#include <optional>

#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// The certificate for two bodies that are known to be separate: from the outermost wrappers on, what meets
/// is refined, of two regions the larger one, and at the end all is taken back in that can be. None for
/// bodies that are not closed or intersect themselves, or that are nearer than wrapper_margin(): what hides
/// them cannot then be told from them.
std::optional<Separation> find_separation(QueryContext& context);

}  // namespace lrb
