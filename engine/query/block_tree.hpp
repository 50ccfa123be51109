#pragma once

namespace lrb {
class BlockTree {};
}  // namespace lrb
