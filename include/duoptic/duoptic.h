// All that most programs need: sources, pipeline, people, outputs, calibration. docs/api.md is the page to begin with. Drawing,
// evaluation, rendered clips and cameras have headers of their own.
#pragma once

#include "duoptic/calibrate.h"
#include "duoptic/frame_files.h"
#include "duoptic/pipeline.h"
#include "duoptic/version.h"
