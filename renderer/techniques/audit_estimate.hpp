#pragma once
#include <span>

#include "renderer/film/film_statistics.hpp"
#include "shaders/shared/film_shared.h"

namespace limn {

/// relMSE of a picture and its 95 % interval from records of single pixels, as many of every tile, record i of tile
/// i % (tilesX * tilesY). With two independent unbiased means h and k of a pixel, E[(x−h)(x−k)] = (x−truth)²: bias counts, the
/// noise of h and k does not. Infinity without records of at least kLeastTiles tiles. Any thread.
FilmError estimateFromAudit(std::span<const shared::AuditRecord> records, uint32_t tilesX, uint32_t tilesY);

/// Whether the noise of the samples makes more of the estimate's variance than the choice of the pixels does: then twice the
/// samples tell more than twice the pixels. Any thread.
bool noiseOutweighsChoice(std::span<const shared::AuditRecord> records, uint32_t tilesX, uint32_t tilesY);

constexpr uint32_t kLeastTiles = 16;

}  // namespace limn
