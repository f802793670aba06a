// Replaces the global allocation functions of the program, so that what a job allocates counts on its
// MemoryAccount. Programs link this file as an object (the target fleetplan_allocation).

#include <malloc.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "core/runtime/memory_account.h"
#include "core/runtime/memory_lack.h"

// ThreadSanitizer keeps its own functions: its suppressions for libraries that are not built for it see only
// their direct callers.
#ifndef FLEETPLAN_THREAD_SANITIZER

// All forms are replaced, even forms whose defaults call others, because the forms of a sanitizer do not.
// NOLINTBEGIN(cppcoreguidelines-no-malloc, cppcoreguidelines-owning-memory, misc-new-delete-overloads)

namespace {

using fleetplan::core::memory_tally;

constexpr std::size_t kLength = 8;

/// Returns what a block of this size takes in the GNU C library, its length included: a multiple of 16 bytes.
/// It is computed where the size is known, as asking for it would double the cost of counting.
constexpr std::size_t taken(std::size_t size) {
#ifdef FLEETPLAN_ADDRESS_SANITIZER
  return size + kLength;
#else
  return std::max<std::size_t>(32, (size + kLength + 15) & ~std::size_t{15});
#endif
}
std::size_t taken_by(void* memory) noexcept { return malloc_usable_size(memory) + kLength; }

void* lacking(std::size_t size) noexcept {
  fleetplan::core::note_memory_lack(size);
  return nullptr;
}

void* counted(void* memory, std::size_t bytes) noexcept {
  if (memory == nullptr) return lacking(bytes);
  if (memory_tally.charge(bytes)) return memory;
  std::free(memory);
  return nullptr;
}

void* allocate(std::size_t size) noexcept { return counted(std::malloc(size), taken(size)); }

void* allocate(std::size_t size, std::align_val_t alignment) noexcept {
  void* memory = nullptr;
  const auto at_least = std::max(static_cast<std::size_t>(alignment), sizeof(void*));
  if (posix_memalign(&memory, at_least, size) != 0) return lacking(size);
  return counted(memory, taken_by(memory));
}

void* or_throw(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void release(void* memory) noexcept {
  if (memory != nullptr) memory_tally.credit(taken_by(memory));
  std::free(memory);
}

void release(void* memory, std::size_t size) noexcept {
  if (memory != nullptr) memory_tally.credit(taken(size));
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return or_throw(allocate(size)); }
void* operator new[](std::size_t size) { return or_throw(allocate(size)); }
void* operator new(std::size_t size, std::align_val_t align) { return or_throw(allocate(size, align)); }
void* operator new[](std::size_t size, std::align_val_t align) { return or_throw(allocate(size, align)); }
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept { return allocate(size); }
void* operator new[](std::size_t size, const std::nothrow_t& /*tag*/) noexcept { return allocate(size); }
void* operator new(std::size_t size, std::align_val_t align, const std::nothrow_t& /*tag*/) noexcept {
  return allocate(size, align);
}
void* operator new[](std::size_t size, std::align_val_t align, const std::nothrow_t& /*tag*/) noexcept {
  return allocate(size, align);
}

void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t size) noexcept { release(memory, size); }
void operator delete[](void* memory, std::size_t size) noexcept { release(memory, size); }
void operator delete(void* memory, std::align_val_t /*align*/) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t /*align*/) noexcept { release(memory); }
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*align*/) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t /*size*/, std::align_val_t /*align*/) noexcept {
  release(memory);
}
void operator delete(void* memory, const std::nothrow_t& /*tag*/) noexcept { release(memory); }
void operator delete[](void* memory, const std::nothrow_t& /*tag*/) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t /*align*/, const std::nothrow_t& /*tag*/) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::align_val_t /*align*/, const std::nothrow_t& /*tag*/) noexcept {
  release(memory);
}

// NOLINTEND(cppcoreguidelines-no-malloc, cppcoreguidelines-owning-memory, misc-new-delete-overloads)

#endif  // FLEETPLAN_THREAD_SANITIZER
