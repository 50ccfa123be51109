#pragma once

#include "engine/collide/query_context.hpp"
#include <lrbscope/collide.hpp>

namespace lrb {

/// Sets interiors_overlap, contacts and regions of a result, as far as requested.
void describe_contact(QueryContext& context, const CollideRequest& request, CollideResult& result);

}  // namespace lrb
