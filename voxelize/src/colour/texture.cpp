#include "texture.h"

#include "../work/workers.h"
#include "srgb.h"

#include <algorithm>
#include <cmath>

namespace voxrt::voxelize {
namespace {

double finite_or_zero(double value) { return std::isfinite(value) ? value : 0; }

/// A coordinate wrapped into 0 … 1, or 0 … 2 where mirrored; exact for coordinates of any size.
double wrapped(double coordinate, Wrap wrap) {
    switch (wrap) {
    case Wrap::clamp:
        return coordinate > 0 ? std::min(coordinate, 1.0) : 0;
    case Wrap::repeat:
        return finite_or_zero(coordinate - std::floor(coordinate));
    default: {
        const double rest = finite_or_zero(std::fmod(coordinate, 2.0));
        return rest < 0 ? rest + 2 : rest;
    }
    }
}

/// A pixel's index wrapped into the image; it is -1 … size, or up to twice the size where mirrored.
int64_t index(int64_t pixel, int64_t size, Wrap wrap) {
    switch (wrap) {
    case Wrap::clamp:
        return std::clamp<int64_t>(pixel, 0, size - 1);
    case Wrap::repeat:
        return pixel < 0 ? pixel + size : pixel >= size ? pixel - size : pixel;
    default: {
        const int64_t turned = (pixel + 2 * size) % (2 * size);
        return std::min(turned, 2 * size - 1 - turned);
    }
    }
}

Light light_of(const uint8_t* pixel) {
    const std::array<double, 256>& linear = SrgbCurve::get().linear();
    return {linear[pixel[0]], linear[pixel[1]], linear[pixel[2]], pixel[3] / 255.0};
}

Light mixed(const Light& from, const Light& to, double share) {
    Light found;
    for (int channel = 0; channel < 4; ++channel)
        found[channel] = from[channel] + (to[channel] - from[channel]) * share;
    return found;
}

/// The tables of halved().
struct Halving {
    std::array<float, 256> linear, share;
    std::vector<uint8_t> srgb; // by light of 16 bits

    Halving() : srgb(1 << 16) {
        for (int code = 0; code < 256; ++code) {
            linear[code] = static_cast<float>(SrgbCurve::get().linear()[code]);
            share[code] = static_cast<float>(code / 255.0);
        }
        for (int light = 0; light < 1 << 16; ++light)
            srgb[light] = srgb_from_linear(light / 65535.0);
    }

    static const Halving& get() {
        static const Halving tables;
        return tables;
    }
};

float mean(const std::array<float, 4>& of) { return ((of[0] + of[1]) + (of[2] + of[3])) * 0.25f; }

/// One row of halved(), of the rows `upper` and `lower`.
void halve_row(const uint8_t* upper, const uint8_t* lower, int64_t width, uint8_t* out) {
    const Halving& tables = Halving::get();
    for (int64_t x = 0; x < width; x += 2, out += 4) {
        const int64_t beside = std::min(x + 1, width - 1);
        // In the order in which rows are added first, and then columns.
        const uint8_t* const four[4] = {upper + 4 * x, lower + 4 * x, upper + 4 * beside, lower + 4 * beside};
        const bool opaque = (four[0][3] & four[1][3] & four[2][3] & four[3][3]) == 255;
        std::array<float, 4> share;
        for (int i = 0; i < 4; ++i)
            share[i] = tables.share[four[i][3]];
        const float alpha = opaque ? 1 : mean(share);
        for (int channel = 0; channel < 3; ++channel) {
            std::array<float, 4> light, covered;
            for (int i = 0; i < 4; ++i) {
                light[i] = tables.linear[four[i][channel]];
                covered[i] = light[i] * share[i];
            }
            const float found = opaque || !(alpha > 0) ? mean(light) : mean(covered) / alpha;
            out[channel] = tables.srgb[static_cast<uint16_t>(found * 65535 + 0.5f)];
        }
        out[3] = static_cast<uint8_t>(std::floor(alpha * 255 + 0.5f));
    }
}

} // namespace

Light look_up(const Texture& texture, double u, double v) {
    const auto& [pixels, width, height] = texture.image;
    const double x = wrapped(u, texture.wrap_u) * double(width), y = wrapped(v, texture.wrap_v) * double(height);
    const auto row = [&, width = width, height = height, pixels = pixels](int64_t at) {
        return pixels + 4 * width * index(at, height, texture.wrap_v);
    };
    const auto column = [&, width = width](int64_t at) { return 4 * index(at, width, texture.wrap_u); };
    if (texture.nearest)
        return light_of(row(static_cast<int64_t>(std::floor(y))) + column(static_cast<int64_t>(std::floor(x))));
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const uint8_t *upper = row(static_cast<int64_t>(top)), *lower = row(static_cast<int64_t>(top) + 1);
    const int64_t here = column(static_cast<int64_t>(left)), beside = column(static_cast<int64_t>(left) + 1);
    const double across = x - 0.5 - left, down = y - 0.5 - top;
    return mixed(mixed(light_of(upper + here), light_of(upper + beside), across),
                 mixed(light_of(lower + here), light_of(lower + beside), across), down);
}

std::vector<uint8_t> halved(const Image& image, int threads) {
    const int64_t columns = (image.width + 1) / 2, rows = (image.height + 1) / 2;
    std::vector<uint8_t> out(static_cast<size_t>(4 * columns * rows));
    constexpr int64_t kStrip = 64; // rows of a job
    Workers(threads).run(static_cast<size_t>((rows + kStrip - 1) / kStrip), [&](size_t strip, int) {
        const int64_t first = static_cast<int64_t>(strip) * kStrip;
        for (int64_t y = first; y < std::min(first + kStrip, rows); ++y) {
            const uint8_t* upper = image.pixels + 4 * image.width * 2 * y;
            const uint8_t* lower = 2 * y + 1 < image.height ? upper + 4 * image.width : upper;
            halve_row(upper, lower, image.width, out.data() + 4 * columns * y);
        }
    });
    return out;
}

} // namespace voxrt::voxelize
