// What body.js takes of three.js, bundled by esbuild (CMakeLists.txt) into one script whose value is called THREE.
export {
  AmbientLight, BufferAttribute, BufferGeometry, ColorManagement, DataTexture, DirectionalLight, DoubleSide, Group, LineBasicMaterial,
  LinearFilter, LinearSRGBColorSpace, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, MeshPhongMaterial, OrthographicCamera,
  Plane, Raycaster, REVISION, Scene, Spherical, Vector2, Vector3, WebGLRenderer
} from 'three';
export { OrbitControls } from 'three/addons/controls/OrbitControls.js';
