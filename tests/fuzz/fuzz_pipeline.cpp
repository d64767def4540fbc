// Any bytes as what a GStreamer pipeline writes.
#include "tests/fuzz/fuzz_streams.h"

int fuzz_pipeline(const std::uint8_t* data, std::size_t size) {
  duo::fuzz::set_up();
  duo::StreamInput input([] { return false; });
  if (input.open_pipeline(duo::fuzz::Bytes(data, size)).empty()) duo::fuzz::read_all(input);
  return 0;
}
