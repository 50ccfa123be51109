#include "tests/support/counted_new.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace lrb::test {
namespace {

thread_local std::uint64_t left = kNoFailure;
thread_local bool failed = false;
thread_local std::uint64_t allocation_count = 0;
thread_local std::int64_t kept = 0;  // bytes

/// Null if it is this allocation's turn to fail.
void* allocate(std::size_t size, std::size_t alignment) {
  ++allocation_count;
  if (left != kNoFailure && left-- == 0) {
    left = kNoFailure;
    failed = true;
    return nullptr;
  }
  const std::size_t whole = (std::max(size, std::size_t{1}) + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, whole);
  kept += static_cast<std::int64_t>(malloc_usable_size(memory));
  return memory;
}

void release(void* memory) {
  kept -= static_cast<std::int64_t>(malloc_usable_size(memory));
  std::free(memory);
}

void* allocate_or_throw(std::size_t size, std::size_t alignment) {
  if (void* memory = allocate(size, alignment)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void fail_allocation_after(std::uint64_t count) {
  left = count;
  failed = false;
}

bool allocation_has_failed() {
  return failed;
}

std::uint64_t allocations() {
  return allocation_count;
}

std::int64_t bytes_in_use() {
  return kept;
}

}  // namespace lrb::test

using lrb::test::allocate;
using lrb::test::allocate_or_throw;
using lrb::test::release;

// Every form that is used: under ASan a form left out would be ASan's own, which frees only its own memory.
void* operator new(std::size_t size) {
  return allocate_or_throw(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size) {
  return operator new(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocate(size, alignof(std::max_align_t));
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}
void operator delete[](void* memory) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  release(memory);
}
