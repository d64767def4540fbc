// Any bytes as what a web server sends; the first one says whether it calls them a row of pictures.
#include "tests/fuzz/fuzz_streams.h"

int fuzz_web(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  duo::fuzz::set_up();
  duo::StreamInput input([] { return false; });
  const char* kind = data[0] % 2 == 0 ? "multipart/x-mixed-replace; boundary=cut" : "";
  if (input.open_web(duo::fuzz::Bytes(data + 1, size - 1), kind).empty()) duo::fuzz::read_all(input);
  return 0;
}
