#include <sys/mman.h>

#include <cstdint>

#include "duoptic/image.h"

namespace duo {

// A volume of 40 MB is 10,000 pages of 4 kB. In a virtual machine each of them that is looked up takes two walks through
// tables: there eight paths take half the time on pages of 2 MB.
void prefer_large_pages(void* memory, std::size_t bytes) {
  constexpr std::uintptr_t kLarge = std::uintptr_t{1} << 21;
  const auto address = reinterpret_cast<std::uintptr_t>(memory), first = (address + kLarge - 1) / kLarge * kLarge,
             end = (address + bytes) / kLarge * kLarge;
  if (end < first + 2 * kLarge) return;
  madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);  // advice: nothing depends on it
}

}  // namespace duo
