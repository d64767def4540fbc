// Included by C++ and by GLSL.
#ifndef DUO_SETTLE_CLEAR_PARAMS_H
#define DUO_SETTLE_CLEAR_PARAMS_H
#ifdef __cplusplus
namespace duo::vk {
#endif

struct SettleClearPush {
  int soften, clear;  // of SgmParams
};

#ifdef __cplusplus
}  // namespace duo::vk
#endif
#endif
