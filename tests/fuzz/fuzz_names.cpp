// Any text as the name of a board, of a paper, of a camera, as a pipeline, and its lines as clicks on joints.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/check.h"
#include "duoptic/board.h"
#include "duoptic/skeleton.h"
#include "duoptic/tracker.h"
#include "sources/camera/modes.h"
#include "sources/gst_process.h"

/// What is accepted has one click per joint of each skeleton, at a place.
static void read_clicks(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char letter : text)
    if (letter == '\n')
      lines.emplace_back();
    else
      lines.back() += letter;
  const duo::Skeleton* const skeletons[] = {&duo::kLeftArm, &duo::kRightArm, &duo::kBody};
  const auto selections = duo::parse_selections(lines, "left", skeletons);
  if (!selections) return;
  for (const duo::Selection& selection : *selections) {
    DUO_CHECK(selection.clicks.size() == selection.skeleton->joints.size());
    for (const duo::Click& click : selection.clicks) {
      DUO_CHECK(std::isfinite(click.x_px) && std::isfinite(click.y_px));
      const auto same = [&](const duo::Click& other) { return other.joint == click.joint; };
      DUO_CHECK(std::count_if(selection.clicks.begin(), selection.clicks.end(), same) == 1);
    }
  }
}

int fuzz_names(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto board = duo::parse_board(text, 0.025)) {
    const auto again = duo::parse_board(board->name(), 0.025);
    DUO_CHECK(again && again->columns == board->columns && again->rows == board->rows);
  }
  if (const auto paper = duo::parse_paper(text)) DUO_CHECK(paper->short_mm > 0 && paper->short_mm < paper->long_mm);
  duo::SystemCalls none;  // a machine without cameras
  none.open = [](const std::string&) { return errno = ENOENT, -1; };
  if (duo::is_camera_name(text)) static_cast<void>(duo::camera_path(none, text));
  read_clicks(text);
  std::size_t letters = 0;
  for (const std::string& word : duo::words_of(text)) letters += word.size();
  DUO_CHECK(letters <= size);
  return 0;
}
