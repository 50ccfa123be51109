#include "tests/support/counted_new.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace lrb::test {
namespace {

thread_local std::uint64_t left = kNoFailure;
thread_local bool failed = false;
thread_local std::uint64_t allocation_count = 0;
std::atomic<std::size_t> held{0}, most{0};

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
  if (memory == nullptr) return nullptr;
  const std::size_t now = held += malloc_usable_size(memory);
  for (std::size_t peak = most; now > peak && !most.compare_exchange_weak(peak, now);) {
  }
  return memory;
}

void* allocate_or_throw(std::size_t size, std::size_t alignment) {
  if (void* memory = allocate(size, alignment)) return memory;
  throw std::bad_alloc();
}

void give_back(void* memory) {
  if (memory != nullptr) held -= malloc_usable_size(memory);
  std::free(memory);
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

PeakMemory::PeakMemory() : before_(held) {
  most = before_;
}

std::size_t PeakMemory::bytes() const {
  return most - before_;
}

}  // namespace lrb::test

using lrb::test::allocate;
using lrb::test::allocate_or_throw;
using lrb::test::give_back;

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
  give_back(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  give_back(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  give_back(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  give_back(memory);
}
void operator delete[](void* memory) noexcept {
  give_back(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  give_back(memory);
}
