t = np.array([[0.1, .5, 1e-3, 0x3c00], [1.0, 2., -3, 4]], dtype=np.float32)  # four
