// Included by C++ and by GLSL.
#ifndef DUO_BALANCE_PARAMS_H
#define DUO_BALANCE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo {
#endif

const int kBalanceCell = 8;      // px, both ways
const int kBalanceReach = 2;     // cells to each side that a census looks at
const int kBalanceAround = 24;   // cells of a census
const int kBalanceApart = 7;     // from a cell of the census to the one it is compared with
const int kBalanceAlike = 3;     // bits of a census by which two that see the same may differ
const int kBalanceDark = 8;      // a mean below has pixels that are cut off, likely
const int kBalanceBright = 247;  // and one above
const int kBalanceFewest = 16;   // pairs of cells
const int kBalanceMost = 255;    // disparity, in cells: those beyond are not looked for

#ifdef __cplusplus
namespace vk {
#endif

const int kBalanceGroup = 128;        // invocations that look at a row of cells, and that make the table
const int kBalanceSums = 3;           // words of a row of cells: count, sum, sum of squares
const int kBalanceOutside = 1 << 24;  // in a cell's mean and in its census: not all of its pixels are inside

struct BalanceCellsPush {
  Plane left, right, left_inside, right_inside;
  int across, down;  // cells
  int masked;        // 0 or 1: there are inside pictures
};

struct BalanceCensusPush {
  int across, down;
};

struct BalanceSumsPush {
  int across, down;
  int most;  // disparity, in cells
};

struct BalanceTablePush {
  int down;
  int looks;  // 0 or 1: whether the pictures are clear is known
};

struct BalancePush {
  Plane src, dst;
  int width, height;
};

#ifdef __cplusplus
}  // namespace vk
}  // namespace duo
#endif
#endif
