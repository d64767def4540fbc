// Included by C++ and by GLSL.
#ifndef DUO_BALANCE_PARAMS_H
#define DUO_BALANCE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
namespace duo::vk {
#endif

const int kBalanceGroup = 128;  // invocations that sum a row, and that make the table
const int kBalanceSums = 3;     // words of a row: count, sum, sum of squares

struct BalanceSumsPush {
  Plane left, right, left_inside, right_inside;
  int width, height;
  int masked;  // 0 or 1: there are inside pictures
};

struct BalanceTablePush {
  int rows;  // of one picture
};

struct BalancePush {
  Plane src, dst;
  int width, height;
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
