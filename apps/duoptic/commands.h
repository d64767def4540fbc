// The subcommands in the order of the help; each has a file, and a namespace of its name with an add().
#pragma once

#include "command.h"

#ifdef DUO_VIEWER
#define DUO_VIEWER_COMMANDS(EACH) EACH(view)
#else
#define DUO_VIEWER_COMMANDS(EACH)
#endif

#define DUO_COMMANDS(EACH)  \
  EACH(depth)               \
  EACH(track)               \
  EACH(eval)                \
  EACH(bench)               \
  EACH(demo)                \
  EACH(synth)               \
  EACH(board)               \
  EACH(rig)                 \
  EACH(calibrate)           \
  EACH(play)                \
  EACH(record)              \
  EACH(cameras)             \
  EACH(detect)              \
  EACH(batch)               \
  DUO_VIEWER_COMMANDS(EACH) \
  EACH(version)             \
  EACH(devices)

#define DUO_DECLARE(name)     \
  namespace duo::app::name {  \
  Command add(CLI::App& app); \
  }
DUO_COMMANDS(DUO_DECLARE)
#undef DUO_DECLARE
