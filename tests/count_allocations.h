#pragma once
/// \file
/// Counts allocations, by replacing operator new: for one file of a program, and not under sanitizers, which replace it
/// too.

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace percale::test {

inline std::atomic<bool> counting{false};
inline std::atomic<int> allocations{0};

inline void* Allocate(std::size_t size, std::size_t alignment) {
  if (counting) ++allocations;
  void* memory = nullptr;
  if (alignment <= alignof(std::max_align_t)) {
    memory = std::malloc(size > 0 ? size : 1);
  } else {
    memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  }
  if (!memory) throw std::bad_alloc();
  return memory;
}

/// How many allocations `function` makes.
template <class Function>
int CountAllocations(Function&& function) {
  allocations = 0;
  counting = true;
  function();
  counting = false;
  return allocations;
}

}  // namespace percale::test

void* operator new(std::size_t size) {
  return percale::test::Allocate(size, 1);
}
void* operator new[](std::size_t size) {
  return percale::test::Allocate(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return percale::test::Allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return percale::test::Allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
