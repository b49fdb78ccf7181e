#include "mem_text.h"

#include <voxrt/voxelize/work/workers.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <vector>

namespace voxrt::octree {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 17; // words per job
constexpr std::uint32_t kPolynomial = 0xEDB88320u;

constexpr char kDigits[] = "0123456789ABCDEF";

using Pair = std::array<char, 2>;
constexpr std::array<Pair, 256> kPairs = [] {
    std::array<Pair, 256> pairs{};
    for (unsigned byte = 0; byte < 256; ++byte)
        pairs[byte] = {kDigits[byte >> 4], kDigits[byte & 15]};
    return pairs;
}();

constexpr std::array<std::uint8_t, 256> kValues = [] {
    std::array<std::uint8_t, 256> values{};
    values.fill(0xFF);
    for (std::uint8_t digit = 0; digit < 16; ++digit)
        values[static_cast<std::uint8_t>(kDigits[digit])] = digit;
    return values;
}();

constexpr std::uint32_t next_crc(std::uint32_t crc, std::uint8_t byte) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit)
        crc = crc >> 1 ^ (crc & 1 ? kPolynomial : 0);
    return crc;
}

// The register after a line is shifted[0][its byte 0] ^ ... ^ shifted[3][its byte 3] ^ line[0][byte 0 of the word] ^
// ... ^ line[3][byte 3 of the word], byte 0 the lowest.
struct CrcTables {
    std::uint32_t shifted[4][256];
    std::uint32_t line[4][256];
    CrcTables() {
        for (unsigned byte = 0; byte < 256; ++byte)
            for (unsigned place = 0; place < 4; ++place) {
                std::uint32_t crc = std::uint32_t{byte} << 8 * place;
                for (std::size_t i = 0; i < kMemLine; ++i)
                    crc = next_crc(crc, 0);
                shifted[place][byte] = crc;
                std::uint32_t text = 0;
                for (unsigned i = 0; i < kMemLine; ++i) {
                    const unsigned first = 2 * (3 - place);
                    const bool here = i == first || i == first + 1;
                    const char newline = i == 8 && place == 0 ? '\n' : 0; // counted once
                    text = next_crc(text, static_cast<std::uint8_t>(here ? kPairs[byte][i - first] : newline));
                }
                line[place][byte] = text;
            }
    }
};

const CrcTables& tables() {
    static const CrcTables made;
    return made;
}

std::uint32_t crc_register(const Word* words, std::size_t count, std::uint32_t crc) {
    const CrcTables& t = tables();
    for (std::size_t i = 0; i < count; ++i) {
        const Word w = words[i];
        const std::uint32_t line =
            t.line[0][w & 255] ^ t.line[1][w >> 8 & 255] ^ t.line[2][w >> 16 & 255] ^ t.line[3][w >> 24];
        crc = t.shifted[0][crc & 255] ^ t.shifted[1][crc >> 8 & 255] ^ t.shifted[2][crc >> 16 & 255] ^
              t.shifted[3][crc >> 24] ^ line;
    }
    return crc;
}

// A linear map of 32 bits: the image of each bit.
using Map = std::array<std::uint32_t, 32>;

std::uint32_t image_of(const Map& map, std::uint32_t value) {
    std::uint32_t result = 0;
    for (unsigned bit = 0; value != 0; ++bit, value >>= 1)
        if (value & 1)
            result ^= map[bit];
    return result;
}

// Shifts a register by `lines` lines of zeros: powers of one line's map, by squaring.
std::uint32_t shift_lines(std::uint32_t crc, std::size_t lines) {
    Map power;
    for (unsigned bit = 0; bit < 32; ++bit)
        power[bit] = tables().shifted[bit / 8][1u << bit % 8];
    for (; lines != 0; lines >>= 1) {
        if (lines & 1)
            crc = image_of(power, crc);
        Map square;
        for (unsigned bit = 0; bit < 32; ++bit)
            square[bit] = image_of(power, power[bit]);
        power = square;
    }
    return crc;
}

template <typename Work> void in_pieces(std::size_t count, int threads, Work work) {
    const std::size_t pieces = (count + kPiece - 1) / kPiece;
    voxelize::Workers(threads).run(pieces, [&](std::size_t piece, int) {
        voxelize::count_work(static_cast<std::uint32_t>(kPiece / 4));
        const std::size_t begin = piece * kPiece;
        work(piece, begin, std::min(kPiece, count - begin));
    });
}

} // namespace

void write_mem_text(const Word* words, std::size_t count, char* text, int threads) {
    in_pieces(count, threads, [&](std::size_t, std::size_t begin, std::size_t size) {
        char* to = text + kMemLine * begin;
        for (std::size_t i = begin; i < begin + size; ++i, to += kMemLine) {
            const Word w = words[i];
            std::memcpy(to, kPairs[w >> 24].data(), 2);
            std::memcpy(to + 2, kPairs[w >> 16 & 255].data(), 2);
            std::memcpy(to + 4, kPairs[w >> 8 & 255].data(), 2);
            std::memcpy(to + 6, kPairs[w & 255].data(), 2);
            to[8] = '\n';
        }
    });
}

std::uint32_t mem_text_crc32(const Word* words, std::size_t count, std::uint32_t before, int threads) {
    std::vector<std::uint32_t> parts((count + kPiece - 1) / kPiece);
    in_pieces(count, threads, [&](std::size_t piece, std::size_t begin, std::size_t size) {
        parts[piece] = crc_register(words + begin, size, 0);
    });
    std::uint32_t crc = ~before;
    for (std::size_t piece = 0; piece < parts.size(); ++piece)
        crc = shift_lines(crc, std::min(kPiece, count - piece * kPiece)) ^ parts[piece];
    return ~crc;
}

bool read_mem_text(const char* text, std::size_t count, Word* words, int threads) {
    std::atomic<bool> plain{true};
    in_pieces(count, threads, [&](std::size_t, std::size_t begin, std::size_t size) {
        if (!plain.load(std::memory_order_relaxed))
            return;
        const char* from = text + kMemLine * begin;
        std::uint8_t wrong = 0;
        for (std::size_t i = begin; i < begin + size; ++i, from += kMemLine) {
            Word word = 0;
            for (unsigned digit = 0; digit < 8; ++digit) {
                const std::uint8_t value = kValues[static_cast<std::uint8_t>(from[digit])];
                wrong |= value;
                word = word << 4 | (value & 15);
            }
            wrong |= from[8] == '\n' ? 0 : 0x80;
            words[i] = word;
        }
        if (wrong & 0x80)
            plain.store(false, std::memory_order_relaxed);
    });
    return plain.load();
}

} // namespace voxrt::octree
