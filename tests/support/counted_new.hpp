#pragma once
/// Counts what `new` hands out, and makes it fail when a test says so: the executable that has
/// counted_new.cpp allocates through it.

#include <cstdint>

namespace lrb::test {

/// From now on, in this thread: `count` allocations succeed and the next one fails, once. Never: the argument
/// kNoFailure.
inline constexpr std::uint64_t kNoFailure = ~std::uint64_t{0};
void fail_allocation_after(std::uint64_t count);

/// Returns true if the requested failure has occurred.
bool allocation_has_failed();

/// Of this thread, so far.
std::uint64_t allocations();

/// What this thread allocated less what it freed.
std::int64_t bytes_in_use();

}  // namespace lrb::test
