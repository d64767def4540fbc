// The subcommands in the order and under the titles of the help; each has a file, and a namespace of its name with an add().
#pragma once

#include "command.h"

#ifdef DUO_VIEWER
#define DUO_VIEWER_COMMANDS(EACH) EACH(view, "Depth and people")
#else
#define DUO_VIEWER_COMMANDS(EACH)
#endif

#define DUO_COMMANDS(EACH)                \
  DUO_VIEWER_COMMANDS(EACH)               \
  EACH(track, "Depth and people")         \
  EACH(depth, "Depth and people")         \
  EACH(detect, "Depth and people")        \
  EACH(cameras, "Cameras and recordings") \
  EACH(record, "Cameras and recordings")  \
  EACH(play, "Cameras and recordings")    \
  EACH(board, "Rigs")                     \
  EACH(calibrate, "Rigs")                 \
  EACH(rig, "Rigs")                       \
  EACH(batch, "Many recordings")          \
  EACH(quality, "Measuring")              \
  EACH(demo, "Measuring")                 \
  EACH(synth, "Measuring")                \
  EACH(eval, "Measuring")                 \
  EACH(truth, "Measuring")                \
  EACH(bench, "Measuring")                \
  EACH(devices, "This machine")           \
  EACH(version, "This machine")           \
  EACH(manual, "This machine")            \
  EACH(completion, "This machine")

#define DUO_DECLARE(name, title) \
  namespace duo::app::name {     \
  Command add(CLI::App& app);    \
  }
DUO_COMMANDS(DUO_DECLARE)
#undef DUO_DECLARE
