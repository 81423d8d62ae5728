// Renders the two rows of spheres.mjs inside the page.

// Sets a row: roughness 0 to 1 from left to right.
const [COUNT, SIDE] = [11, 96];
// Gives the metal its reflectance at normal incidence. White would hide what scale and bias do.
const COLOUR = 0xffc357;
// Keeps the brightest pixels below 255, where differences would vanish.
const INTENSITY = 0.5;

/** Renders by both copies of three, shows the rows one above the other and compares them. */
export async function renderBoth(table) {
  const [own, replaced] = [await render('/own/', table), await render('/replaced/', table)];
  return {
    width: COUNT * SIDE,
    height: 2 * SIDE,
    own: own.table,
    replacement: replaced.table,
    ...compare(own.pixels, replaced.pixels),
  };
}

/** Renders one row by the copy of three under a URL. Returns its pixels, RGBA, 8 bits each. */
async function render(base, tablePath) {
  const three = await import(`${base}src/Three.js`);
  const { RoomEnvironment } = await import(`${base}examples/jsm/environments/RoomEnvironment.js`);
  const { getDFGLUT } = await import(`${base}${tablePath}`);

  // Leaves the background transparent: alpha tells what is a sphere.
  const renderer = new three.WebGLRenderer({ alpha: true });
  renderer.setSize(COUNT * SIDE, SIDE);
  document.body.append(renderer.domElement);

  const scene = new three.Scene();
  // Takes most of the time: SwiftShader filters the room on the CPU.
  scene.environment = new three.PMREMGenerator(renderer).fromScene(new RoomEnvironment()).texture;
  scene.environmentIntensity = INTENSITY;
  const sphere = new three.SphereGeometry(0.47, 96, 64);
  for (let i = 0; i < COUNT; i++) {
    const look = { color: COLOUR, metalness: 1, roughness: i / (COUNT - 1) };
    const mesh = new three.Mesh(sphere, new three.MeshStandardMaterial(look));
    mesh.position.x = i + 0.5;
    scene.add(mesh);
  }
  const camera = new three.OrthographicCamera(0, COUNT, 0.5, -0.5, 0.1, 10);
  camera.position.z = 5;
  renderer.render(scene, camera);

  const gl = renderer.getContext();
  const pixels = new Uint8Array(COUNT * SIDE * SIDE * 4);
  gl.readPixels(0, 0, COUNT * SIDE, SIDE, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const { width, height } = getDFGLUT().image;
  return { pixels, table: `${width} x ${height}` };
}

/** Compares the spheres' pixels, in steps of 8 bits. The background counts for nothing. */
function compare(a, b) {
  let [largest, sum, count, roughness] = [0, 0, 0, 0];
  for (let i = 0; i < a.length; i += 4) {
    if (a[i + 3] === 0) continue;
    count += 1;
    for (let c = 0; c < 3; c++) {
      const difference = Math.abs(a[i + c] - b[i + c]);
      sum += difference;
      if (difference <= largest) continue;
      largest = difference;
      roughness = Math.floor(((i / 4) % (COUNT * SIDE)) / SIDE) / (COUNT - 1);
    }
  }
  if (count === 0) throw new Error('no sphere was drawn');
  return { pixels: count, mean: sum / (3 * count), largest, largestAtRoughness: roughness };
}
