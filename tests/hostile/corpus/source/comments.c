/* 1, 2 */ static const uint16_t t[2][4] = { 0x3c00, 0x3800, // 3
 0x0, 0x1u, 1.0f, 2.5e-1f, -.5, +3 };
