// One libFuzzer program for all readers: the environment's DUOPTIC_READER says which of them gets the bytes.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#define DUOPTIC_READERS(DO) \
  DO(rig) DO(ros) DO(kalibr) DO(recording) DO(export) DO(pictures) DO(web) DO(pipeline) DO(camera) DO(net) DO(pfm) DO(names) DO(kept)

#define DUOPTIC_DECLARE(name) int fuzz_##name(const std::uint8_t* data, std::size_t size);
DUOPTIC_READERS(DUOPTIC_DECLARE)

namespace {

struct Reader {
  std::string_view name;
  int (*read)(const std::uint8_t* data, std::size_t size);
};

#define DUOPTIC_READER(name) Reader{#name, fuzz_##name},
constexpr std::array kReaders{DUOPTIC_READERS(DUOPTIC_READER)};

const Reader& chosen_reader() {
  const char* const wanted = std::getenv("DUOPTIC_READER");
  for (const Reader& reader : kReaders)
    if (wanted != nullptr && reader.name == wanted) return reader;
  std::fputs("DUOPTIC_READER must name one of:", stderr);
  for (const Reader& reader : kReaders) std::fprintf(stderr, " %s", reader.name.data());
  std::fputs("\n", stderr);
  std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Reader& reader = chosen_reader();
  return reader.read(data, size);
}
