#include "duoptic/version.h"

#define DUO_TEXT_INNER(x) #x
#define DUO_TEXT(x) DUO_TEXT_INNER(x)

namespace duo {

const char* version() {
  return DUO_TEXT(DUOPTIC_VERSION_MAJOR) "." DUO_TEXT(DUOPTIC_VERSION_MINOR) "." DUO_TEXT(DUOPTIC_VERSION_PATCH);
}

}  // namespace duo
