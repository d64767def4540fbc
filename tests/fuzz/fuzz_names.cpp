// Any text as the name of a board, of a paper, of a camera, and as a pipeline.
#include <cstdint>
#include <string>

#include "core/check.h"
#include "duoptic/board.h"
#include "sources/camera/modes.h"
#include "sources/gst_process.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto board = duo::parse_board(text, 0.025)) {
    const auto again = duo::parse_board(board->name(), 0.025);
    DUO_CHECK(again && again->columns == board->columns && again->rows == board->rows);
  }
  if (const auto paper = duo::parse_paper(text)) DUO_CHECK(paper->short_mm > 0 && paper->short_mm < paper->long_mm);
  duo::SystemCalls none;  // a machine without cameras
  none.open = [](const std::string&) { return errno = ENOENT, -1; };
  if (duo::is_camera_name(text)) static_cast<void>(duo::camera_path(none, text));
  std::size_t letters = 0;
  for (const std::string& word : duo::words_of(text)) letters += word.size();
  DUO_CHECK(letters <= size);
  return 0;
}
