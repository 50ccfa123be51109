#pragma once

#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// Fills in interiors_overlap, contacts and regions of a result, as far as the request asks for them.
void describe_contact(QueryContext& context, const CollideRequest& request, CollideResult& result);

}  // namespace lrb
