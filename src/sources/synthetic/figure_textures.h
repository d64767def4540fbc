// What a person's skin, hair and clothes look like, on the resting body.
#pragma once

#include "sources/synthetic/textures.h"

namespace duo::synthetic {

Color skin(const Material& m, const TexturePoint& at);
Color face(const Material& m, const TexturePoint& at);
Color hair(const Material& m, const TexturePoint& at);
Color print(const Material& m, const TexturePoint& at);
Color stripes(const Material& m, const TexturePoint& at);
Color plaid(const Material& m, const TexturePoint& at);
Color denim(const Material& m, const TexturePoint& at);

}  // namespace duo::synthetic
