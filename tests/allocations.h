// Heap allocations of the whole test program, counted by its operator new (allocations.cpp).
#pragma once

#include <atomic>

namespace duo::test {
extern std::atomic<long> allocations, allocated_bytes;  // what was freed is not taken off
}
