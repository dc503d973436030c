// Camera, mouse and drawing. Nothing is drawn unless something has changed.
import { Color, OrthographicCamera, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const radians = Math.PI / 180;
/** As in polycrystal.png: 28 degrees from -TD towards RD, 24 degrees above. */
const from = new Vector3(
  Math.cos(24 * radians) * Math.sin(28 * radians),
  -Math.cos(24 * radians) * Math.cos(28 * radians),
  Math.sin(24 * radians),
);

/** Throws if the browser has no WebGL 2. */
export function makeView(holder, onDraw) {
  const canvas = document.createElement('canvas');
  const context = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
  if (!context) throw new Error('no WebGL 2');
  const renderer = new WebGLRenderer({ canvas, context });
  holder.prepend(canvas);
  const scene = new Scene();
  const camera = new OrthographicCamera();
  camera.up.set(0, 0, 1);
  const controls = new OrbitControls(camera, canvas);
  let radius = 1,
    due = false;

  const draw = () => {
    due = false;
    renderer.render(scene, camera);
    onDraw(camera);
  };
  const request = () => {
    if (!due) requestAnimationFrame(draw);
    due = true;
  };
  const resize = () => {
    const { clientWidth: width, clientHeight: height } = holder;
    const half = 0.92 * radius * Math.max(1, height / width);
    camera.left = (-half * width) / height;
    camera.right = -camera.left;
    camera.top = half;
    camera.bottom = -half;
    camera.near = 0;
    camera.far = 20 * radius;
    camera.updateProjectionMatrix();
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(width, height, false);
    request();
  };
  controls.addEventListener('change', request);
  // A canvas is printed as it was last seen, in other colours perhaps; a picture of it is not.
  const printed = new Image();
  printed.className = 'printed';
  printed.decoding = 'sync';
  holder.append(printed);
  addEventListener('beforeprint', () => {
    printed.src = canvas.toDataURL();
  });
  new ResizeObserver(resize).observe(holder);

  const turn = () => {
    camera.zoom = 1;
    camera.position.copy(controls.target).addScaledVector(from, 10 * radius);
    controls.update();
    resize();
  };
  return {
    scene,
    request,
    draw,
    turn,
    /** Looks at the middle of a body of this half diagonal, from where it looks now. */
    aim(middle, half) {
      const shift = new Vector3(...middle).sub(controls.target);
      controls.target.add(shift);
      camera.position.add(shift);
      radius = half;
      resize();
    },
    background(colour) {
      scene.background = new Color(colour);
      draw(); // at once: a print does not wait
    },
    /** Number of the triangle of `body` under the mouse, or -1. */
    pick(body, event) {
      const box = canvas.getBoundingClientRect();
      const at = new Vector2(
        (2 * (event.clientX - box.left)) / box.width - 1,
        1 - (2 * (event.clientY - box.top)) / box.height,
      );
      const ray = new Raycaster();
      ray.setFromCamera(at, camera);
      return ray.intersectObject(body)[0]?.faceIndex ?? -1;
    },
  };
}
