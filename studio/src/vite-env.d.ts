/// <reference types="vite/client" />
declare module "*.lzma?inline" {
  const url: string;
  export default url;
}
declare module "*.gz?inline" {
  const url: string;
  export default url;
}
