// A board in simulation, steered by lines on standard input: clocks, a monitor on the DVI pins, a host on the serial
// line. Works for the sources and for a netlist: only the pins of the top are touched.
//
//   frames N     run until the monitor has seen N more whole frames; answer each by a line and 640 x 480 x 3 bytes
//   send HEX     give bytes to the host, which sends them from now on
//   run N        run N pixel clocks
//   received     answer the bytes that the host has received since the last time, in hexadecimal
//   baud N       the host's baud
//   buttons N    set the buttons, bit by bit
//   leds         answer the LEDs
//
// A monitor finds the words of each channel by DVI's control words, as a receiver does, and decodes them by the
// standard (DVI 1.0, section 3.3.3); of the design it knows nothing.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <iostream>
#include <string>
#include <vector>

#include "Vtop.h"
#include "verilated.h"

namespace {

constexpr int ticks_per_bit = 6; // Ticks per bit; a bit clock has two bits.
constexpr int ticks_per_pixel = 30;
constexpr int64_t ticks_per_second = 750'000'000;
constexpr int columns = 640, rows = 480;

struct Word {
    bool visible;
    int control;
    int value;
};

Word decode(int word) {
    switch (word) {
    case 0b1101010100:
        return {false, 0, 0};
    case 0b0010101011:
        return {false, 1, 0};
    case 0b0101010100:
        return {false, 2, 0};
    case 0b1010101011:
        return {false, 3, 0};
    default:
        break;
    }
    int bits = word & 0xFF;
    if (word & 0x200)
        bits ^= 0xFF;
    int value = bits & 1;
    for (int i = 1; i < 8; ++i) {
        const int difference = (bits >> i & 1) ^ (bits >> (i - 1) & 1);
        value |= (word & 0x100 ? difference : !difference) << i;
    }
    return {true, 0, value};
}

class Channel {
public:
    // Takes a bit; gives true when a word is complete.
    bool take(bool bit) {
        shift_ = (shift_ >> 1 | bit << 9) & 0x3FF;
        ++count_;
        const bool control = !decode(shift_).visible;
        if (!locked_) {
            // Two control words one word apart: inside the data of other words they do not occur twice so.
            if (control && count_ >= 10) {
                same_ = count_ == 10 ? same_ + 1 : 0;
                count_ = 0;
                locked_ = same_ >= 16;
            }
            return false;
        }
        if (count_ < 10)
            return false;
        count_ = 0;
        balance_ += 2 * __builtin_popcount(shift_) - 10;
        if (control)
            balance_ = 0;
        if (std::abs(balance_) > worst_)
            worst_ = std::abs(balance_);
        return true;
    }
    bool locked() const { return locked_; }
    Word word() const { return decode(shift_); }
    int worst_balance() const { return worst_; }

private:
    int shift_ = 0, count_ = 0, same_ = 0, balance_ = 0, worst_ = 0;
    bool locked_ = false;
};

// What a monitor sees: whole frames from the first vertical sync on, and their timing.
class Monitor {
public:
    struct Frame {
        std::vector<uint8_t> pixels;
        int64_t clocks;              // From vertical sync to vertical sync.
        int visible_rows, sync_rows; // Rows with pixels; rows of vertical sync.
        int row_clocks_least, row_clocks_most, row_pixels_least, row_pixels_most, sync_clocks_least, sync_clocks_most;
        int front_columns, front_rows; // From the last pixel to the sync; from the last row with pixels to the sync.
        int worst_balance;
        int mixed_words; // Pixels of some channels with control words of others.
    };

    void take(const std::array<bool, 3>& bits) {
        bool word = false;
        for (int c = 0; c < 3; ++c) {
            const bool complete = channels_[c].take(bits[c]);
            if (complete)
                ready_ |= 1 << c;
            if (!channels_[c].locked())
                ready_ = 0;
        }
        word = ready_ == 7;
        if (!word)
            return;
        ready_ = 0;
        pixel();
    }

    std::deque<Frame> frames;

private:
    void pixel() {
        std::array<Word, 3> words;
        for (int c = 0; c < 3; ++c)
            words[c] = channels_[c].word();
        ++frame_clocks_;
        ++row_clocks_;
        const bool visible = words[0].visible && words[1].visible && words[2].visible;
        if (visible != (words[0].visible || words[1].visible || words[2].visible))
            ++now_.mixed_words;
        if (visible) {
            if (recording_) {
                for (int c = 2; c >= 0; --c)
                    now_.pixels.push_back(static_cast<uint8_t>(words[c].value));
            }
            ++row_pixels_;
            since_pixel_ = 0;
            return;
        }
        ++since_pixel_;
        const bool hsync = !(words[0].control & 1), vsync = !(words[0].control & 2); // Low when they pulse.
        if (hsync)
            ++sync_clocks_;
        if (hsync && !hsync_) {
            // A row begins at its sync.
            if (rows_ > 0)
                widen(now_.row_clocks_least, now_.row_clocks_most, row_clocks_);
            if (vsync)
                ++now_.sync_rows;
            if (row_pixels_) {
                ++now_.visible_rows;
                widen(now_.row_pixels_least, now_.row_pixels_most, row_pixels_);
                now_.front_columns = since_pixel_ - 1;
                rows_since_pixel_ = 0;
            } else {
                ++rows_since_pixel_;
            }
            ++rows_;
            row_clocks_ = row_pixels_ = 0;
        }
        if (!hsync && hsync_) {
            widen(now_.sync_clocks_least, now_.sync_clocks_most, sync_clocks_);
            sync_clocks_ = 0;
        }
        if (vsync && !vsync_) {
            if (recording_) {
                now_.clocks = frame_clocks_;
                for (const Channel& channel : channels_)
                    now_.worst_balance = std::max(now_.worst_balance, channel.worst_balance());
                frames.push_back(std::move(now_));
            }
            recording_ = true;
            now_ = Frame{};
            now_.row_clocks_least = now_.row_pixels_least = now_.sync_clocks_least = 1 << 30;
            now_.front_rows = rows_since_pixel_;
            now_.pixels.reserve(columns * rows * 3);
            frame_clocks_ = 0;
            rows_ = 0;
        }
        hsync_ = hsync;
        vsync_ = vsync;
    }

    static void widen(int& least, int& most, int value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }

    std::array<Channel, 3> channels_;
    int ready_ = 0;
    Frame now_{};
    bool recording_ = false, hsync_ = false, vsync_ = false;
    int64_t frame_clocks_ = 0;
    int row_clocks_ = 0, row_pixels_ = 0, sync_clocks_ = 0, since_pixel_ = 0, rows_ = 0, rows_since_pixel_ = 0;
};

// 8 bits, no parity, one stop bit.
class Host {
public:
    std::deque<uint8_t> to_send;
    std::vector<uint8_t> received;
    int64_t baud = 3'000'000;

    bool line(int64_t tick) {
        if (sending_ < 0 && !to_send.empty()) {
            sending_ = 1 << 9 | to_send.front() << 1;
            to_send.pop_front();
            begin_ = tick;
        }
        if (sending_ < 0)
            return true;
        const int64_t bit = (tick - begin_) * baud / ticks_per_second;
        if (bit >= 10) {
            sending_ = -1;
            return true;
        }
        return sending_ >> bit & 1;
    }

    void listen(int64_t tick, bool line) {
        if (start_ < 0) {
            if (!line)
                start_ = tick, bits_ = 0, value_ = 0;
            return;
        }
        // The middles of the bits.
        if ((tick - start_) * 2 * baud < (2 * bits_ + 1) * ticks_per_second)
            return;
        if (bits_ >= 1 && bits_ <= 8)
            value_ |= line << (bits_ - 1);
        if (bits_ == 9) {
            if (line)
                received.push_back(static_cast<uint8_t>(value_));
            start_ = -1;
            return;
        }
        ++bits_;
    }

private:
    int sending_ = -1;
    int64_t begin_ = 0, start_ = -1;
    int bits_ = 0, value_ = 0;
};

class Board {
public:
    Monitor monitor;
    Host host;
    Vtop top;

    // A tick is a period of the PLL's 750 MHz; bits change twice in a bit clock.
    void run(int64_t ticks) {
        for (const int64_t end = tick_ + ticks; tick_ < end;) {
            top.clk = !top.clk;
            if (tick_ % ticks_per_bit == 0)
                top.uart_rx = host.line(tick_);
            top.eval();
            ++tick_;
            if (tick_ % (ticks_per_bit / 2) == 2) {
                monitor.take({(top.dvi & 1) != 0, (top.dvi & 2) != 0, (top.dvi & 4) != 0});
            }
            if (tick_ % ticks_per_bit == 0)
                host.listen(tick_, top.uart_tx);
        }
    }

private:
    int64_t tick_ = 0;
};

} // namespace

int main(int argc, char** argv) {
    Verilated::commandArgs(argc, argv);
    std::ios::sync_with_stdio(false);
    Board board;
    board.top.buttons = 0;
    std::string command;
    while (std::cin >> command) {
        if (command == "frames") {
            int count = 0;
            std::cin >> count;
            board.monitor.frames.clear(); // what it saw while requests were answered
            for (int64_t budget = (count + 3LL) * 900 * 600 * ticks_per_pixel; count > 0 && budget > 0;) {
                board.run(800 * ticks_per_pixel);
                budget -= 800 * ticks_per_pixel;
                for (; count > 0 && !board.monitor.frames.empty(); --count) {
                    const Monitor::Frame& f = board.monitor.frames.front();
                    std::cout << f.pixels.size() << ' ' << f.clocks << ' ' << f.visible_rows << ' ' << f.sync_rows
                              << ' ' << f.row_clocks_least << ' ' << f.row_clocks_most << ' ' << f.row_pixels_least
                              << ' ' << f.row_pixels_most << ' ' << f.sync_clocks_least << ' ' << f.sync_clocks_most
                              << ' ' << f.front_columns << ' ' << f.front_rows << ' ' << f.worst_balance << ' '
                              << f.mixed_words << '\n';
                    std::cout.write(reinterpret_cast<const char*>(f.pixels.data()),
                                    static_cast<std::streamsize>(f.pixels.size()));
                    board.monitor.frames.pop_front();
                }
            }
            if (count > 0)
                std::cout << "none\n";
        } else if (command == "send") {
            std::string text;
            std::cin >> text;
            for (size_t i = 0; i + 1 < text.size(); i += 2) {
                board.host.to_send.push_back(static_cast<uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
            }
        } else if (command == "run") {
            int64_t clocks = 0;
            std::cin >> clocks;
            board.run(clocks * ticks_per_pixel);
        } else if (command == "received") {
            for (const uint8_t byte : board.host.received) {
                char text[3];
                std::snprintf(text, sizeof text, "%02x", byte);
                std::cout << text;
            }
            std::cout << '\n';
            board.host.received.clear();
        } else if (command == "baud") {
            std::cin >> board.host.baud;
        } else if (command == "buttons") {
            int buttons = 0;
            std::cin >> buttons;
            board.top.buttons = static_cast<uint8_t>(buttons);
        } else if (command == "leds") {
            std::cout << static_cast<int>(board.top.leds) << '\n';
        } else {
            std::cerr << "what is " << command << "?\n";
            return 2;
        }
        std::cout.flush();
    }
    return 0;
}
