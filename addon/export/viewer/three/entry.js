export {
  AnimationMixer, Color, DirectionalLight, Fog, HemisphereLight, InstancedMesh, LineBasicMaterial, MeshLambertMaterial, NearestFilter,
  OrthographicCamera, PerspectiveCamera, Scene, Sphere, SRGBColorSpace, Vector3, WebGLRenderer,
} from "three";
export { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
