// Textures that are drawn rather than grown: wallpaper, rug, book covers, poster.
#pragma once

#include "sources/synthetic/textures.h"

namespace duo::synthetic {

Color wallpaper(const Material& material, const TexturePoint& at);
Color rug(const Material& material, const TexturePoint& at);
Color book(const Material& material, const TexturePoint& at);
Color poster(const Material& material, const TexturePoint& at);

}  // namespace duo::synthetic
